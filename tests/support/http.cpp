// SPDX-License-Identifier: Apache-2.0
// A socket, a request, everything until the other side closes.
#include "tests/support/http.h"

#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

namespace turbid::test {

HttpAnswer ask(const std::string& url, const HttpRequest& request) {
  const std::string place = url.substr(7, url.rfind('/') - 7);  // after http://
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(std::stoi(place.substr(place.find(':') + 1))));
  inet_pton(AF_INET, place.substr(0, place.find(':')).c_str(), &address.sin_addr);
  const int to = socket(AF_INET, SOCK_STREAM, 0);
  std::string got;
  if (connect(to, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0) {
    const std::string text = request.method + " " + request.path +
                             " HTTP/1.1\r\nHost: " + (request.host.empty() ? place : request.host) +
                             "\r\nConnection: close\r\n" + request.headers +
                             "Content-Length: " + std::to_string(request.body.size()) + "\r\n\r\n" + request.body;
    send(to, text.data(), text.size(), MSG_NOSIGNAL);
    char buffer[65536];
    for (ssize_t count; (count = recv(to, buffer, sizeof buffer, 0)) > 0;)
      got.append(buffer, static_cast<std::size_t>(count));
  }
  close(to);
  const std::size_t end = got.find("\r\n\r\n");
  if (end == std::string::npos || got.size() < 12) return {};
  return {std::stoi(got.substr(9, 3)), got.substr(0, end), got.substr(end + 4)};
}

}  // namespace turbid::test
