// SPDX-License-Identifier: Apache-2.0
// One HTTP request at a time, byte for byte as the test says.
#pragma once
#include <string>

namespace turbid::test {

struct HttpAnswer {
  int status = 0;  ///< 0: no answer
  std::string head, body;
};

struct HttpRequest {
  std::string method = "GET", path = "/", body = {};
  std::string host = {};     ///< header Host; empty: the address itself
  std::string headers = {};  ///< further ones, each ended by "\r\n"
};

/// Asks `url`, an http://127.0.0.1:PORT/ address.
HttpAnswer ask(const std::string& url, const HttpRequest&);

}  // namespace turbid::test
