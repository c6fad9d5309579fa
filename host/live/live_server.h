// SPDX-License-Identifier: Apache-2.0
// The live view over HTTP: the page, its pictures, and what it asks for. Only pages of the server itself may change
// anything, and only names that can't be rebound (an address, localhost) reach it.
#pragma once
#include <memory>
#include <string>

#include "host/live/live_worker.h"

namespace turbid {

class LiveServer {
 public:
  /// Binds; port 0 takes any that is free. Throws InputError if that can't be. The worker outlives the server.
  LiveServer(LiveWorker& worker, const std::string& address, int port);
  ~LiveServer();
  std::string url() const;
  /// Answers requests on threads of its own, until stop().
  void start();
  void stop();

 private:
  struct Http;
  void add_pages();
  void add_actions();

  LiveWorker& worker_;
  std::string address_;
  int port_ = 0;
  std::unique_ptr<Http> http_;
};

/// Whether a request may pass, by its headers Host and Origin ("" if it has none).
bool trusted_host(const std::string& host);
bool trusted_origin(const std::string& origin, const std::string& host);

}  // namespace turbid
