// SPDX-License-Identifier: Apache-2.0
#include "cli/server_options.hpp"

#include <CLI/CLI.hpp>

#include "cli/streams.hpp"

namespace nadir::cli {

std::vector<CLI::Option*> add_server_options(CLI::App& verb, ServerOptions& server) {
  CLI::Option* port = verb.add_option("--port", server.port, "Port of the viewer; 0 = any free one")
                          ->check(CLI::Range(0, 65535))
                          ->capture_default_str();
  CLI::Option* listen =
      verb.add_option("--listen", server.listen,
                      "Address to listen at; any but this machine's own lets others watch")
          ->type_name("ADDRESS")
          ->capture_default_str();
  return {port, listen};
}

void warn_where_open(const ServerOptions& server, bool quiet) {
  if (server.listen == "127.0.0.1" || server.listen == "localhost" || server.listen == "::1")
    return;
  print_note("warning: whoever can reach " + server.listen +
                 " can watch this run and set its pose; there is no password",
             quiet);
}

}  // namespace nadir::cli
