// SPDX-License-Identifier: Apache-2.0
// Who may talk to the live view. A page from elsewhere can make a browser send requests here: those that change
// something carry that page's Origin. It can also have its own name resolve to this machine (DNS rebinding): then the
// name stands in Host.
#include <arpa/inet.h>

#include <algorithm>
#include <cctype>

#include "host/live/live_server.h"

namespace turbid {
namespace {

/// `name:port` or `[address]:port` without the port and the brackets.
std::string without_port(const std::string& host) {
  if (host.starts_with('[')) {
    const std::size_t end = host.find(']');
    return end == std::string::npos ? "" : host.substr(1, end - 1);
  }
  return host.substr(0, host.find(':'));
}

}  // namespace

bool trusted_host(const std::string& host) {
  std::string name = without_port(host);
  std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return std::tolower(c); });
  in_addr v4;
  in6_addr v6;
  return name == "localhost" || inet_pton(AF_INET, name.c_str(), &v4) == 1 ||
         inet_pton(AF_INET6, name.c_str(), &v6) == 1;
}

bool trusted_origin(const std::string& origin, const std::string& host) {
  return origin.empty() || origin == "http://" + host;
}

}  // namespace turbid
