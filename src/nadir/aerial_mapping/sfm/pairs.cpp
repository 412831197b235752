// SPDX-License-Identifier: Apache-2.0
#include "nadir/aerial_mapping/sfm/pairs.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <tuple>

namespace nadir::aerial {
namespace {

constexpr std::size_t kInTime = 2;  // before and after

using Links = std::set<std::pair<std::size_t, std::size_t>>;

void link(Links& links, std::size_t a, std::size_t b) {
  if (a != b) links.emplace(std::min(a, b), std::max(a, b));
}

void link_nearest(Links& links, const std::vector<MappingPhoto>& photos, int neighbours) {
  for (std::size_t i = 0; i < photos.size(); ++i) {
    if (!photos[i].prior.position) continue;
    std::vector<std::pair<double, std::size_t>> others;
    for (std::size_t j = 0; j < photos.size(); ++j) {
      if (j == i || !photos[j].prior.position) continue;
      const auto& p = *photos[i].prior.position;
      const auto& q = *photos[j].prior.position;
      others.emplace_back(std::hypot(p.x - q.x, p.y - q.y), j);
    }
    const std::size_t count = std::min(others.size(), static_cast<std::size_t>(neighbours));
    std::partial_sort(others.begin(), others.begin() + static_cast<std::ptrdiff_t>(count),
                      others.end());
    for (std::size_t k = 0; k < count; ++k) link(links, i, others[k].second);
  }
}

void link_in_time(Links& links, const std::vector<MappingPhoto>& photos) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < photos.size(); ++i)
    if (photos[i].prior.taken_at) order.push_back(i);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::tuple(photos[a].camera, *photos[a].prior.taken_at) <
           std::tuple(photos[b].camera, *photos[b].prior.taken_at);
  });
  for (std::size_t k = 0; k < order.size(); ++k)
    for (std::size_t step = 1; step <= kInTime && k + step < order.size(); ++step)
      if (photos[order[k]].camera == photos[order[k + step]].camera)
        link(links, order[k], order[k + step]);
}

}  // namespace

PhotoPairs choose_pairs(const std::vector<MappingPhoto>& photos, int neighbours) {
  Links links;
  link_nearest(links, photos, neighbours);
  link_in_time(links, photos);
  for (std::size_t i = 0; i < photos.size(); ++i)
    if (!photos[i].prior.position)
      for (std::size_t j = 0; j < photos.size(); ++j) link(links, i, j);
  return {links.begin(), links.end()};
}

std::vector<std::vector<std::size_t>> components_of(std::size_t photos, const PhotoPairs& links) {
  std::vector<std::size_t> root(photos);
  std::iota(root.begin(), root.end(), std::size_t{0});
  const auto find = [&](std::size_t i) {
    while (root[i] != i) i = root[i] = root[root[i]];
    return i;
  };
  for (const auto& [a, b] : links) {
    const std::size_t ra = find(a);
    const std::size_t rb = find(b);
    root[std::max(ra, rb)] = std::min(ra, rb);
  }
  std::vector<std::vector<std::size_t>> groups(photos);
  for (std::size_t i = 0; i < photos; ++i) groups[find(i)].push_back(i);
  std::erase_if(groups, [](const auto& group) { return group.empty(); });
  std::stable_sort(groups.begin(), groups.end(),
                   [](const auto& a, const auto& b) { return a.size() > b.size(); });
  return groups;
}

}  // namespace nadir::aerial
