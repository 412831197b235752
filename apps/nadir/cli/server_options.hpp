// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "viewer/viewer_server.hpp"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace nadir::cli {

/// --port, --listen.
std::vector<CLI::Option*> add_server_options(CLI::App& verb, ServerOptions& server);

/// Says so where other machines can reach the server.
void warn_where_open(const ServerOptions& server, bool quiet);

}  // namespace nadir::cli
