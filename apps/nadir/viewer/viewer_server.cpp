// SPDX-License-Identifier: Apache-2.0
#include "viewer/viewer_server.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <charconv>
#include <mutex>
#include <nlohmann/json.hpp>

#include "nadir/core/error.hpp"
#include "nadir/io/base64.hpp"
#include "nadir/viewer/http_server.hpp"
#include "nadir/viewer/web_assets.hpp"

namespace nadir::cli {
namespace {

constexpr const char* kContentPolicy =
    "default-src 'none'; script-src 'self'; style-src 'self' 'unsafe-inline'; "
    "img-src 'self' data: blob:; connect-src 'self'; base-uri 'none'; form-action 'none'; "
    "frame-ancestors 'none'";
constexpr double kLargestSpread = 1000.0;  ///< metres
constexpr auto kHeartbeat = std::chrono::seconds(5);

bool is_loopback(const std::string& address) {
  return address == "127.0.0.1" || address == "localhost" || address == "::1";
}

/// A name can be made to point here by whoever owns it (DNS rebinding); a number cannot.
bool is_numeric_address(const std::string& host) {
  return !host.empty() && (host.front() == '[' || std::ranges::all_of(host, [](char c) {
                             return (c >= '0' && c <= '9') || c == '.';
                           }));
}

std::string host_without_port(const std::string& host) {
  if (host.starts_with('[')) return host.substr(0, host.find(']') + 1);
  return host.substr(0, host.find(':'));
}

void answer(httplib::Response& response, const Json& document) {
  response.set_content(json_text(document), "application/json");
}

void refuse(httplib::Response& response, int status, const std::string& problem) {
  response.status = status;
  answer(response, Json{{"error", problem}});
}

/// Immutable content for as long as the server runs.
void cacheable(httplib::Response& response) {
  response.set_header("Cache-Control", "private, max-age=600");
}

std::optional<std::size_t> index_in(const httplib::Request& request, std::size_t group = 1) {
  const std::string text = request.matches[group];
  std::size_t index = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), index);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return index;
}

/// What a watcher asks the filter to start at; throws Error (usage) that says what is wrong.
Prior prior_in(const std::string& body) {
  const Json request = Json::parse(body, nullptr, false);
  const auto number = [&](const char* key, double lowest, double highest) {
    if (!request.is_object() || !request.contains(key) || !request[key].is_number()) {
      throw Error(ErrorKind::kUsage, std::string("'") + key + "' is missing or no number");
    }
    const double value = request[key].get<double>();
    if (!(value >= lowest && value <= highest)) {
      throw Error(ErrorKind::kUsage, fmt::format("'{}' is not in {} .. {}", key, lowest, highest));
    }
    return value;
  };
  constexpr double kAnywhere = 1e8;  // metres: beyond every projection
  Prior prior;
  prior.pose = {number("x", -kAnywhere, kAnywhere), number("y", -kAnywhere, kAnywhere),
                wrap_angle(number("yaw", -10.0, 10.0))};
  prior.spread.position_m = number("position_m", 0.0, kLargestSpread);
  prior.spread.yaw_rad = number("yaw_spread", 0.0, kPi);
  return prior;
}

}  // namespace

struct ViewerServer::State {
  const RunView& run;
  const EventHub* events;
  std::function<void(const Prior&)> restart;
  ServerOptions options;
  HttpServer server{options.limits};
  int port = 0;
  std::atomic<int> watchers{0};
  std::mutex document_mutex{};

  bool allowed_host(const httplib::Request& request) const {
    const std::string host = host_without_port(request.get_header_value("Host"));
    if (host == "127.0.0.1" || host == "localhost" || host == "[::1]") return true;
    return !is_loopback(options.listen) && (host == options.listen || is_numeric_address(host));
  }

  void set_policies();
  void serve_page();
  void serve_run();
  void serve_pictures();
  void serve_events();
  void serve_initial_pose();
};

void ViewerServer::State::set_policies() {
  server.set_pre_routing_handler([this](const auto& request, auto& response) {
    response.set_header("Content-Security-Policy", kContentPolicy);
    response.set_header("X-Content-Type-Options", "nosniff");
    response.set_header("Referrer-Policy", "no-referrer");
    response.set_header("Cross-Origin-Resource-Policy", "same-origin");
    if (allowed_host(request)) return httplib::Server::HandlerResponse::Unhandled;
    refuse(response, 403, "this server does not go by that name");
    return httplib::Server::HandlerResponse::Handled;
  });
  server.set_exception_handler([](const auto&, auto& response, const std::exception_ptr& thrown) {
    try {
      std::rethrow_exception(thrown);
    } catch (const std::exception& error) {
      refuse(response, 500, error.what());
    } catch (...) {
      refuse(response, 500, "unknown error");
    }
  });
}

/// The page and its parts are in the program; a path is looked up in that list and nowhere else.
void ViewerServer::State::serve_page() {
  server.Get(".*", [](const auto& request, auto& response) {
    const std::string path = request.path == "/" ? "/index.html" : request.path;
    const auto assets = web_assets();
    const auto found =
        std::ranges::find_if(assets, [&](const WebAsset& asset) { return asset.path == path; });
    if (found == assets.end()) return refuse(response, 404, "there is nothing of that name");
    response.set_header("ETag", found->etag);
    response.set_header("Cache-Control", "no-cache");
    if (request.get_header_value("If-None-Match") == found->etag) {
      response.status = 304;
      return;
    }
    response.set_header("Content-Encoding", "gzip");
    response.set_content(found->gzip.data(), found->gzip.size(), found->media_type);
  });
}

void ViewerServer::State::serve_run() {
  server.Get("/api/run", [this](const auto&, auto& response) {
    // One at a time: as a tree, a long run takes a hundred times the memory of its text.
    const std::scoped_lock lock(document_mutex);
    Json document = run.document();
    document["newest_event"] = events == nullptr ? 0 : events->newest();
    document["can_restart"] = restart != nullptr && run.live();
    answer(response, document);
    response.set_header("Cache-Control", "no-store");
  });
  server.Get(R"(/api/particles/(\d{1,9}))", [this](const auto& request, auto& response) {
    const auto index = index_in(request);
    const auto particles = index ? run.particles(*index) : std::nullopt;
    if (!particles) return refuse(response, 404, "no particles are known of that frame");
    response.set_content(reinterpret_cast<const char*>(particles->data()),
                         particles->size() * sizeof(LoggedParticle), "application/octet-stream");
    cacheable(response);
  });
}

void ViewerServer::State::serve_pictures() {
  server.Get(R"(/api/tiles/(\d{1,2})/(\d{1,7})/(\d{1,7}))",
             [this](const auto& request, auto& response) {
               const auto tile = run.tiles().tile(static_cast<int>(*index_in(request, 1)),
                                                  static_cast<int>(*index_in(request, 2)),
                                                  static_cast<int>(*index_in(request, 3)));
               if (!tile) return refuse(response, 404, "there is no such tile");
               response.set_content(tile->bytes, tile->media_type);
               cacheable(response);
             });
  server.Get(R"(/api/local/(\d{1,9}))", [this](const auto& request, auto& response) {
    const auto index = index_in(request);
    const auto local = index ? run.local_map(*index) : std::nullopt;
    if (!local) return refuse(response, 404, "there is no such local map");
    answer(response, Json{{"west", local->geo.west},
                          {"north", local->geo.north},
                          {"resolution", local->geo.resolution},
                          {"width", local->width},
                          {"height", local->height},
                          {"png", base64(local->image.bytes)}});
    cacheable(response);
  });
  server.Get(R"(/api/heat/(\d{1,9}))", [this](const auto& request, auto& response) {
    const auto index = index_in(request);
    const auto heat = index ? run.heat_map(*index) : std::nullopt;
    if (!heat) return refuse(response, 404, "this frame cannot be compared with the map");
    answer(response, *heat);
    cacheable(response);
  });
}

void ViewerServer::State::serve_events() {
  server.Get("/api/events", [this](const auto& request, auto& response) {
    if (events == nullptr) return refuse(response, 404, "the run is finished: nothing happens");
    if (++watchers > options.most_watchers) {
      --watchers;
      return refuse(response, 503, "too many watchers");
    }
    std::uint64_t last = 0;
    const std::string id = request.get_header_value("Last-Event-ID");
    std::from_chars(id.data(), id.data() + id.size(), last);
    if (id.empty() && request.has_param("after")) {
      const std::string after = request.get_param_value("after");
      std::from_chars(after.data(), after.data() + after.size(), last);
    }
    response.set_header("Cache-Control", "no-store");
    response.set_chunked_content_provider(
        "text/event-stream",
        [this, last](std::size_t, httplib::DataSink& sink) mutable {
          const std::vector<ViewerEvent> news = events->after(last, kHeartbeat, server.stopping());
          if (server.stopping().stop_requested()) return false;
          std::string text = news.empty() ? ": still here\n\n" : "";
          for (const ViewerEvent& event : news) {
            text +=
                fmt::format("id: {}\nevent: {}\ndata: {}\n\n", event.id, event.name, event.data);
            last = event.id;
          }
          if (events->closed() && events->newest() == last) {
            sink.write(text.data(), text.size());
            sink.done();
            return true;
          }
          return sink.write(text.data(), text.size());
        },
        [this](bool) { --watchers; });
  });
}

void ViewerServer::State::serve_initial_pose() {
  server.Post("/api/initial_pose", [this](const auto& request, auto& response) {
    const std::string origin = request.get_header_value("Origin");
    if (!origin.empty() && origin != "http://" + request.get_header_value("Host")) {
      return refuse(response, 403, "a page of another origin may not set the pose");
    }
    if (!request.get_header_value("Content-Type").starts_with("application/json")) {
      return refuse(response, 415, "send application/json");
    }
    if (!restart || !run.live()) {
      return refuse(response, 409, "the run is finished: start one with `nadir localize --serve`");
    }
    try {
      restart(prior_in(request.body));
    } catch (const Error& error) {
      return refuse(response, 400, error.what());
    }
    answer(response, Json{{"accepted", true}});
  });
}

ViewerServer::ViewerServer(const RunView& run, const EventHub* events,
                           std::function<void(const Prior&)> restart, const ServerOptions& options)
    : state_(new State{run, events, std::move(restart), options}) {
  state_->set_policies();
  state_->serve_run();
  state_->serve_pictures();
  state_->serve_events();
  state_->serve_initial_pose();
  state_->serve_page();
}

ViewerServer::~ViewerServer() { stop(); }

void ViewerServer::start() {
  const ServerOptions& options = state_->options;
  state_->port = state_->server.start(options.listen, options.port);
  if (state_->port == 0) {
    throw Error(ErrorKind::kUsage, "cannot listen there",
                fmt::format("{}:{}", options.listen, options.port),
                "another program may have the port: give --port 0 for any free one");
  }
}

void ViewerServer::stop() { state_->server.stop(); }

int ViewerServer::port() const { return state_->port; }

std::string ViewerServer::url() const {
  const std::string& listen = state_->options.listen;
  const bool anywhere = listen == "0.0.0.0" || listen == "::";
  return fmt::format("http://{}:{}/", anywhere ? "127.0.0.1" : listen, state_->port);
}

int ViewerServer::watchers() const { return state_->watchers.load(); }

}  // namespace nadir::cli
