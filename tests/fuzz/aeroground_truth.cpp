// SPDX-License-Identifier: Apache-2.0
#include "fuzz/fuzz_site.hpp"
#include "fuzz/fuzz_target.hpp"
#include "nadir/io/drives/aeroground.hpp"
#include "nadir/io/drives/sequence.hpp"
#include "nadir/io/photos/photo_file.hpp"

// truth.txt beside a map and two local maps.
NADIR_FUZZ_TARGET(aeroground_truth) {
  const std::filesystem::path folder = nadir::fuzz::scratch_folder() / "aero";
  if (!std::filesystem::exists(folder / "global_no_cars.jpg")) {
    std::filesystem::create_directories(folder / "local");
    nadir::Photo picture;
    picture.image = nadir::fuzz::small_map(16, 16, {0.0, 0.0}).image;
    for (const char* name : {"local/1.jpg", "local/2.jpg", "global_no_cars.jpg"}) {
      nadir::write_photo(folder / name, picture);
    }
  }
  nadir::fuzz::as_file("aero/truth.txt", input);
  nadir::convert_aeroground(folder, nadir::fuzz::scratch_folder() / "converted", {}, {});
  const auto site = nadir::read_sequence(nadir::fuzz::scratch_folder() / "converted");
  nadir::fuzz::require(site.local_maps.size() == 2, "a local map is missing");
}
