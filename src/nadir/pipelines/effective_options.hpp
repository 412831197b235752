// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "nadir/aerial_mapping/options.hpp"
#include "nadir/ground_mapping/local_map.hpp"
#include "nadir/ground_mapping/options.hpp"
#include "nadir/io/options/yaml_options.hpp"
#include "nadir/localizer.hpp"
#include "nadir/pipelines/simulate/simulation_options.hpp"

namespace nadir {

/// What the user says about the options of a run, in any of the ways there are.
struct OptionSources {
  std::string preset = "default";
  std::filesystem::path config;   ///< empty = none
  std::vector<std::string> sets;  ///< "stage.name=value"

  /// A flag of its own for one option: "--score".
  struct Flag {
    std::string flag;
    std::string option;
    std::optional<std::string> value;
  };
  std::vector<std::shared_ptr<Flag>> flags;
};

/// The options of every stage, in the order of the pipeline.
struct StageOptions {
  AerialMappingOptions aerial_mapping;
  GroundMappingOptions ground_mapping;
  RenderOptions local_map;
  LocalizerOptions localizer;
  SimulationOptions simulation;
};

/// All of them, dotted by stage. `options` must outlive the table.
OptionTable option_table(StageOptions& options);

/// The options of a run, and where each value came from. By rising precedence: default, preset,
/// config file, environment (NADIR_MAP_MATCHING_SCORE), --set, flag.
class EffectiveOptions {
 public:
  /// Throws Error (usage) for a name or a value that no option knows, (input) for a config file
  /// that cannot be read.
  explicit EffectiveOptions(const OptionSources& sources);
  EffectiveOptions(const EffectiveOptions&) = delete;
  EffectiveOptions& operator=(const EffectiveOptions&) = delete;
  EffectiveOptions(EffectiveOptions&&) = delete;
  EffectiveOptions& operator=(EffectiveOptions&&) = delete;
  ~EffectiveOptions() = default;

  /// Lets `--device` choose the backend; `auto` takes the GPU where one is usable and nobody named
  /// a backend.
  void use_device(const std::string& device);

  const LocalizerOptions& values() const { return values_.localizer; }
  const AerialMappingOptions& aerial_mapping() const { return values_.aerial_mapping; }
  const GroundMappingOptions& ground_mapping() const { return values_.ground_mapping; }
  const RenderOptions& local_map() const { return values_.local_map; }
  const SimulationOptions& simulation() const { return values_.simulation; }
  const OptionTable& table() const { return table_; }
  const OptionOrigins& origins() const { return origins_; }

 private:
  void set(const std::string& name, const std::string& value, const std::string& origin);
  void apply_preset(const std::string& preset);
  void apply_environment();
  void apply_set(const std::string& assignment);

  StageOptions values_;
  OptionTable table_;
  OptionOrigins origins_;
};

/// "NADIR_MAP_MATCHING_SCORE" for "map_matching.score".
std::string environment_name(const std::string& option);

}  // namespace nadir
