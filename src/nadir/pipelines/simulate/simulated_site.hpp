// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "nadir/core/stop.hpp"
#include "nadir/pipelines/simulate/simulation_options.hpp"
#include "nadir/simulation/simulated_drive.hpp"
#include "nadir/simulation/simulated_flight.hpp"

namespace nadir {

/// Which sensors the robot carries.
enum class DriveSensors { kStereo, kLidar, kBoth };

/// A place, a flight over it and a drive through it, ready to be written in the formats that real
/// ones come in.
class SimulatedSite {
 public:
  using Tick = std::function<void()>;  ///< after every photo and every frame

  /// Writing throws Stopped where `stop` asks for it.
  SimulatedSite(const SimulatedWorld& world, const SimulationOptions& options, std::uint64_t seed,
                StopToken stop);

  /// The photos to take: all that the overlap asks for, or the `most` nearest to the drive.
  std::vector<int> photos(int most) const;
  const SimulatedFlight& flight() const { return flight_; }
  const SimulatedDrive& drive() const { return drive_; }
  double travel_m() const;

  /// JPEGs with EXIF and XMP.
  void write_photos(const std::filesystem::path& folder, const std::vector<int>& photos,
                    const Tick& tick) const;
  void write_stereo(const std::filesystem::path& folder, const Tick& tick) const;
  void write_lidar(const std::filesystem::path& folder, const Tick& tick) const;
  /// What a perfect pipeline would make of it: a site with the true orthomosaic and surface at the
  /// flight, the true local maps with their heights, the odometry and the true poses; and
  /// photo_poses.csv, the true poses of the cameras.
  void write_truth(const std::filesystem::path& folder, const std::vector<int>& photos,
                   const std::string& name, const Tick& tick) const;

 private:
  Trajectory truth_on_grid() const;

  SimulatedWorld world_;
  SimulatedScene at_flight_;
  SimulatedFlight flight_;
  SimulatedDrive drive_;
  StopToken stop_;
};

/// "photo_0007.jpg", as the metadata of the photo has it too.
std::string photo_name(int photo);

}  // namespace nadir
