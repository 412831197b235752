// SPDX-License-Identifier: Apache-2.0
#include "nadir/runs/particle_log.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <cstring>

#include "nadir/core/error.hpp"

namespace nadir {
namespace {

static_assert(std::endian::native == std::endian::little, "particles.bin is little-endian");
static_assert(sizeof(LoggedParticle) == 16);

constexpr std::array<char, 8> kMagic{'N', 'A', 'D', 'I', 'R', 'P', '0', '1'};
constexpr std::uint64_t kHeaderBytes = 24;  ///< magic; anchor x and y as float64

template <class T>
void put(std::ostream& stream, const T& value) {
  std::array<char, sizeof(T)> bytes{};
  std::memcpy(bytes.data(), &value, sizeof(T));
  stream.write(bytes.data(), bytes.size());
}

template <class T>
std::optional<T> get(std::istream& stream) {
  std::array<char, sizeof(T)> bytes{};
  if (!stream.read(bytes.data(), bytes.size())) return std::nullopt;
  T value{};
  std::memcpy(&value, bytes.data(), sizeof(T));
  return value;
}

}  // namespace

std::vector<LoggedParticle> thinned(const ParticleSet& particles, Point2<frames::Map> anchor) {
  const std::size_t stride = (particles.size() + kMostLoggedParticles - 1) / kMostLoggedParticles;
  std::vector<LoggedParticle> logged;
  if (stride == 0) return logged;
  double kept = 0.0;
  for (std::size_t i = 0; i < particles.size(); i += stride) kept += particles.weights[i];
  for (std::size_t i = 0; i < particles.size(); i += stride) {
    const Pose2& pose = particles.poses[i];
    logged.push_back({static_cast<float>(pose.x - anchor.x), static_cast<float>(pose.y - anchor.y),
                      static_cast<float>(pose.yaw),
                      static_cast<float>(kept > 0.0 ? particles.weights[i] / kept : 0.0)});
  }
  return logged;
}

Point2<frames::Map> anchor_near(const Pose2& pose) {
  return {std::round(pose.x), std::round(pose.y)};
}

ParticleLogWriter::ParticleLogWriter(std::filesystem::path file)
    : file_(std::move(file)), stream_(file_, std::ios::binary | std::ios::trunc) {
  if (!stream_) throw Error(ErrorKind::kProcessing, "cannot be created", file_.string());
}

void ParticleLogWriter::append(const ParticleSet& particles) {
  if (!anchor_) {
    anchor_ = particles.poses.empty() ? Point2<frames::Map>{} : anchor_near(particles.poses[0]);
    stream_.write(kMagic.data(), kMagic.size());
    put(stream_, anchor_->x);
    put(stream_, anchor_->y);
  }
  const std::vector<LoggedParticle> logged = thinned(particles, *anchor_);
  put(stream_, static_cast<std::uint32_t>(logged.size()));
  for (const LoggedParticle& particle : logged) put(stream_, particle);
  stream_.flush();
  if (!stream_) {
    throw Error(ErrorKind::kProcessing, "cannot be written", file_.string(),
                "check the free space");
  }
}

ParticleLogReader::ParticleLogReader(std::filesystem::path file)
    : file_(std::move(file)), stream_(file_, std::ios::binary) {
  if (!stream_) throw Error(ErrorKind::kInput, "cannot read the file", file_.string());
  scan();
  if (scanned_ == 0 && stream_.peek() != std::ifstream::traits_type::eof()) {
    throw Error(ErrorKind::kInput, "is no particle log", file_.string(), "run localize again");
  }
}

/// Goes on where the last scan ended; a frame that is not whole yet is left for the next one.
void ParticleLogReader::scan() {
  stream_.clear();
  if (scanned_ == 0) {
    stream_.seekg(0);
    std::array<char, kMagic.size()> magic{};
    stream_.read(magic.data(), magic.size());
    const auto x = get<double>(stream_);
    const auto y = get<double>(stream_);
    if (!y || magic != kMagic) {
      stream_.clear();
      stream_.seekg(0);
      return;
    }
    anchor_ = {*x, *y};
    scanned_ = kHeaderBytes;
  }
  // By the open stream and not by name: the folder of a live run is renamed when the run ends.
  stream_.seekg(0, std::ios::end);
  const auto end = static_cast<std::uint64_t>(std::streamoff(stream_.tellg()));
  while (scanned_ + sizeof(std::uint32_t) <= end) {
    stream_.clear();
    stream_.seekg(static_cast<std::streamoff>(scanned_));
    const auto count = get<std::uint32_t>(stream_);
    if (!count) return;
    const std::uint64_t offset = scanned_ + sizeof(std::uint32_t);
    if (offset + std::uint64_t{*count} * sizeof(LoggedParticle) > end) return;
    extents_.push_back({offset, *count});
    scanned_ = offset + std::uint64_t{*count} * sizeof(LoggedParticle);
  }
}

std::optional<std::vector<LoggedParticle>> ParticleLogReader::read(std::size_t frame) {
  const std::scoped_lock lock(mutex_);
  if (frame >= extents_.size()) scan();
  if (frame >= extents_.size()) return std::nullopt;
  stream_.clear();
  stream_.seekg(static_cast<std::streamoff>(extents_[frame].offset));
  std::vector<LoggedParticle> particles;
  particles.reserve(extents_[frame].count);
  for (std::uint32_t i = 0; i < extents_[frame].count; ++i) {
    const auto particle = get<LoggedParticle>(stream_);
    if (!particle) return std::nullopt;
    particles.push_back(*particle);
  }
  return particles;
}

Point2<frames::Map> ParticleLogReader::anchor() {
  const std::scoped_lock lock(mutex_);
  if (scanned_ == 0) scan();
  return anchor_;
}

}  // namespace nadir
