// SPDX-License-Identifier: Apache-2.0
#include "viewer/live_view.hpp"

#include <nlohmann/json.hpp>
#include <thread>

#include "cli/interrupt.hpp"
#include "nadir/io/base64.hpp"

namespace nadir::cli {
namespace {

constexpr auto kPatience = std::chrono::milliseconds(50);

std::string_view bytes_of(const std::vector<LoggedParticle>& particles) {
  return {reinterpret_cast<const char*>(particles.data()),
          particles.size() * sizeof(LoggedParticle)};
}

}  // namespace

LiveView::LiveView(const RunSources& sources, const LocalizerOptions& options,
                   const std::filesystem::path& particle_file, const ServerOptions& server,
                   double rate_hz)
    : sequence_(read_sequence(sources.site)),
      run_(sources, options, particle_file, true),
      server_(
          run_, &events_,
          [this](const Prior& prior) {
            const std::scoped_lock lock(mutex_);
            asked_ = prior;
          },
          server),
      rate_hz_(rate_hz) {
  server_.start();
}

void LiveView::frame_done(const FrameRecord& record, const ParticleSet& particles) {
  const ViewFrame frame = view_of(record, sequence_);
  run_.add(frame);
  // A run that nobody watches does not pay for its messages.
  if (server_.watchers() > 0) {
    const GeoReference& geo = run_.tiles().geo();
    Json message = to_json(frame);
    message["index"] = run_.size() - 1;
    message["particles"] = base64(bytes_of(thinned(particles, {geo.west, geo.north})));
    events_.publish("frame", json_text(message));
  }
  wait_for_the_next();
}

void LiveView::wait_for_the_next() const {
  if (!(rate_hz_ > 0.0)) return;
  const auto due = last_ + std::chrono::duration<double>(1.0 / rate_hz_);
  while (!interrupted() && std::chrono::steady_clock::now() < due) {
    std::this_thread::sleep_for(
        std::min<std::chrono::duration<double>>(kPatience, due - std::chrono::steady_clock::now()));
  }
}

std::optional<Prior> LiveView::new_start() {
  last_ = std::chrono::steady_clock::now();
  const std::scoped_lock lock(mutex_);
  const std::optional<Prior> prior = std::exchange(asked_, std::nullopt);
  if (prior) {
    events_.publish("restart",
                    json_text({{"pose", {prior->pose.x, prior->pose.y, prior->pose.yaw}}}));
  }
  return prior;
}

void LiveView::serve_until_interrupted() {
  run_.finish();
  events_.publish("finished", "{}");
  wait_for_interrupt();
  events_.close();
}

void wait_for_interrupt() {
  while (!interrupted()) std::this_thread::sleep_for(kPatience);
}

}  // namespace nadir::cli
