// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>

namespace nadir {

/// What one client, and all of them together, may take of the server.
struct HttpLimits {
  std::size_t connections = 256;             ///< open at once; each has a thread
  std::size_t requests = 100;                ///< on one connection, one after the other
  std::size_t request_line = 2048;           ///< bytes
  std::size_t head = 16'384;                 ///< bytes of request line and headers
  std::size_t body = 4096;                   ///< bytes, as they come over the wire
  std::chrono::milliseconds to_ask{10'000};  ///< for a request to come whole
  std::chrono::milliseconds between{5000};   ///< from an answer to the next request's first byte
  std::chrono::milliseconds to_take{5000};   ///< for the client to take the next piece
};

}  // namespace nadir
