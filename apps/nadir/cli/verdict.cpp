// SPDX-License-Identifier: Apache-2.0
#include "cli/verdict.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "cli/interrupt.hpp"

namespace nadir::cli {
namespace {

std::string joined(const std::vector<std::string>& reasons) {
  std::string text;
  for (const std::string& reason : reasons) text += (text.empty() ? "" : ". And: ") + reason;
  return text;
}

}  // namespace

void Verdict::doubt(std::string reason) {
  if (std::ranges::find(doubts_, reason) == doubts_.end()) doubts_.push_back(std::move(reason));
}

void Verdict::doubt(const std::vector<std::string>& reasons) {
  for (const std::string& reason : reasons) doubt(reason);
}

ExitCode Verdict::exit_code() const {
  if (nothing_) return ExitCode::kNothingFound;
  return doubts_.empty() ? ExitCode::kDone : ExitCode::kDoubtful;
}

Json error_document(const std::string& message, int exit_code) {
  return {{"error", {{"message", message}, {"exit_code", exit_code}}}};
}

void add_verdict(Json& document, const Verdict& verdict) {
  document["doubtful"] = verdict.doubts();
  if (!verdict.nothing()) return;
  document.update(error_document(verdict.nothing()->what(), static_cast<int>(verdict.exit_code())));
}

void print_result(Json document, const std::string& text, const Verdict& verdict,
                  const CommonOptions& common) {
  add_verdict(document, verdict);
  common.json ? print(document) : print(text);
}

int conclude(const Verdict& verdict) {
  if (!verdict.doubts().empty()) print_doubt(joined(verdict.doubts()));
  if (verdict.nothing()) print_error(verdict.nothing()->what());
  const int stopped = interrupted() ? interrupted_exit_code() : 0;
  return stopped != 0 ? stopped : static_cast<int>(verdict.exit_code());
}

int finish(Json document, const std::string& text, const Verdict& verdict,
           const CommonOptions& common) {
  print_result(std::move(document), text, verdict, common);
  return conclude(verdict);
}

}  // namespace nadir::cli
