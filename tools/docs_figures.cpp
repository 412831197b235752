// SPDX-License-Identifier: Apache-2.0
// Writes the figures of the documents that the project draws itself: docs_figures FOLDER
#include <exception>
#include <filesystem>
#include <iostream>

#include "nadir/io/image.hpp"
#include "nadir/report/figures.hpp"
#include "simulated_world_sheet.hpp"

int main(int count, char** arguments) try {
  if (count != 2) {
    std::cerr << "usage: docs_figures FOLDER\n";
    return 2;
  }
  nadir::write_png(std::filesystem::path(arguments[1]) / "conventions.png",
                   nadir::draw_conventions());
  nadir::write_png(std::filesystem::path(arguments[1]) / "simulated_world.png",
                   nadir::draw_simulated_world_sheet());
  return 0;
} catch (const std::exception& error) {
  std::cerr << "docs_figures: error: " << error.what() << '\n';
  return 1;
}
