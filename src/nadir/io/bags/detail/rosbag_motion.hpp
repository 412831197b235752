// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "nadir/core/frames3.hpp"
#include "nadir/io/bags/detail/ros1.hpp"
#include "nadir/io/trajectories/pose_file.hpp"

namespace nadir {

/// Where a robot drove, as a bag has it.
struct BagMotion {
  PoseFile poses;
  std::string robot;  ///< the frame that they are of: "base_link"
  std::vector<std::string> notes;
};

/// Of nav_msgs/Odometry, else of odom -> base in tf, else of the only pair of frames that tf moves;
/// or of the topic that is asked for. Nothing where the bag has neither. Throws Error (input) where
/// several fit or none of the poses is one.
std::optional<BagMotion> motion_of(const ros1::Bag& bag, const std::string& asked);

/// The frames that stand fixed to each other: tf_static, and what tf repeats without change.
class FixedFrames {
 public:
  explicit FixedFrames(const ros1::Bag& bag);

  /// target_from_source; nothing where no chain of fixed frames leads from one to the other.
  template <class Target, class Source>
  std::optional<Transform3<Target, Source>> between(const std::string& target,
                                                    const std::string& source) const {
    const auto found = chain(target, source);
    if (!found) return std::nullopt;
    return Transform3<Target, Source>{found->rotation, found->translation};
  }

 private:
  struct Anywhere {};
  using Step = Transform3<Anywhere, Anywhere>;
  struct Parent {
    std::string frame;
    Step parent_from_child;
  };
  struct Ancestor {
    std::string frame;
    Step ancestor_from_start;
  };
  std::optional<Step> chain(const std::string& target, const std::string& source) const;
  std::vector<Ancestor> ancestors(const std::string& frame) const;

  std::map<std::string, Parent> parents_;  ///< by child
};

}  // namespace nadir
