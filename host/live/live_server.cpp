// SPDX-License-Identifier: Apache-2.0
// See live_server.h. Routes: / page.css page.js sliders.js; /state?after=N (waits for news); /picture.png; /scene.toml;
// POST /change (lines as for -D), /save/scene, /save/picture.
#include "host/live/live_server.h"

#include <httplib.h>

#include <charconv>
#include <optional>
#include <sstream>

#include "host/base/errors.h"
#include "host/live/page_files.h"

namespace turbid {
namespace {

constexpr double kPatience = 10;             // a question for news waits so long [s]
constexpr std::size_t kLargestBody = 65536;  // bytes
constexpr std::size_t kThreads = 32;         // a browser holds several connections, each a thread

void say(httplib::Response& response, int status, const std::string& sentence) {
  response.status = status;
  response.set_content(sentence + "\n", "text/plain; charset=utf-8");
}

/// Its lines without empty ones and what a terminal on Windows adds.
std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) {
    if (line.ends_with('\r')) line.pop_back();
    if (!line.empty()) lines.push_back(line);
  }
  return lines;
}

std::optional<std::uint64_t> number_of(const std::string& text) {
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() ? std::optional(value) : std::nullopt;
}

/// What a handler throws becomes an answer of one line.
httplib::Server::Handler answered(std::function<void(const httplib::Request&, httplib::Response&)> handler) {
  return [handler](const httplib::Request& request, httplib::Response& response) {
    try {
      handler(request, response);
    } catch (const InputError& error) {
      say(response, 400, error.what());
    } catch (const std::exception& error) {
      say(response, 500, error.what());
    }
  };
}

}  // namespace

struct LiveServer::Http {
  httplib::Server server;
  std::jthread thread;
};

LiveServer::LiveServer(LiveWorker& worker, const std::string& address, int port)
    : worker_(worker), address_(address), http_(std::make_unique<Http>()) {
  httplib::Server& server = http_->server;
  server.new_task_queue = [] { return new httplib::ThreadPool(kThreads); };
  // httplib's own choice would let two servers share a port.
  server.set_socket_options([](int socket) {
    const int yes = 1;
    setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  });
  server.set_payload_max_length(kLargestBody);
  server.set_keep_alive_max_count(1000000);
  server.set_keep_alive_timeout(1);  // [s]; the end waits for connections that are idle
  server.set_tcp_nodelay(true);
  server.set_default_headers(
      {{"Cache-Control", "no-store"},
       {"X-Content-Type-Options", "nosniff"},
       {"Cross-Origin-Resource-Policy", "same-origin"},
       {"Content-Security-Policy", "default-src 'self'; img-src 'self' blob: data:; frame-ancestors 'none'"}});
  server.set_pre_routing_handler([](const httplib::Request& request, httplib::Response& response) {
    const std::string host = request.get_header_value("Host");
    if (!trusted_host(host)) {
      say(response, 403, "Host " + host + ": expected localhost or this machine's address");
    } else if (request.method != "GET" && !trusted_origin(request.get_header_value("Origin"), host)) {
      say(response, 403, "a page from " + request.get_header_value("Origin") + " may not change anything here");
    } else {
      return httplib::Server::HandlerResponse::Unhandled;
    }
    return httplib::Server::HandlerResponse::Handled;
  });
  add_pages();
  add_actions();
  port_ = port == 0 ? server.bind_to_any_port(address) : server.bind_to_port(address, port) ? port : -1;
  if (port_ >= 0) return;
  in6_addr any;
  const bool literal =
      inet_pton(AF_INET, address.c_str(), &any) == 1 || inet_pton(AF_INET6, address.c_str(), &any) == 1;
  throw InputError("--port " + std::to_string(port) + ": can't be opened on " + address +
                   (literal || address == "localhost" ? "; it may be in use: give another, or 0 for any that is free"
                                                      : ", which is no address of this machine"));
}

LiveServer::~LiveServer() {
  stop();
}

std::string LiveServer::url() const {
  const bool v6 = address_.find(':') != std::string::npos;
  return "http://" + (v6 ? "[" + address_ + "]" : address_) + ":" + std::to_string(port_) + "/";
}

void LiveServer::start() {
  http_->thread = std::jthread([this] { http_->server.listen_after_bind(); });
  while (!http_->server.is_running()) std::this_thread::yield();
}

void LiveServer::stop() {
  http_->server.stop();
}

void LiveServer::add_pages() {
  httplib::Server& server = http_->server;
  const auto page = [&](const char* path, const char* text, const char* type) {
    server.Get(
        path, [text, type](const httplib::Request&, httplib::Response& response) { response.set_content(text, type); });
  };
  page("/", k_page_html, "text/html; charset=utf-8");
  page("/page.css", k_page_css, "text/css; charset=utf-8");
  page("/page.js", k_page_js, "text/javascript; charset=utf-8");
  page("/sliders.js", k_sliders_js, "text/javascript; charset=utf-8");
  server.Get("/state", answered([this](const httplib::Request& request, httplib::Response& response) {
               std::uint64_t after = 0;
               if (request.has_param("after")) {
                 const auto given = number_of(request.get_param_value("after"));
                 if (!given) return say(response, 400, "after: expected a whole number");
                 after = *given;
               }
               response.set_content(worker_.state(after, kPatience), "application/json");
             }));
  server.Get("/picture.png", answered([this](const httplib::Request&, httplib::Response& response) {
               const auto picture = worker_.picture();
               if (!picture) return say(response, 404, "there is no picture yet");
               response.set_header("X-Picture", std::to_string(picture->number));
               response.set_content(reinterpret_cast<const char*>(picture->png.data()), picture->png.size(),
                                    "image/png");
             }));
  server.Get("/scene.toml", answered([this](const httplib::Request&, httplib::Response& response) {
               response.set_content(worker_.scene_text(), "application/toml; charset=utf-8");
             }));
}

void LiveServer::add_actions() {
  httplib::Server& server = http_->server;
  server.Post("/change", answered([this](const httplib::Request& request, httplib::Response& response) {
                const std::vector<std::string> settings = lines_of(request.body);
                if (settings.empty()) return say(response, 400, "expected lines such as camera.fov=30");
                worker_.change(settings);
                say(response, 200, "taken");
              }));
  server.Post("/save/scene", answered([this](const httplib::Request&, httplib::Response& response) {
                response.set_content(saved_json(worker_.save_scene()), "application/json");
              }));
  server.Post("/save/picture", answered([this](const httplib::Request&, httplib::Response& response) {
                response.set_content(saved_json(worker_.save_picture()), "application/json");
              }));
}

}  // namespace turbid
