#include "common/evaluation/help_curve.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <fstream>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <tuple>
#include <utility>

#include "common/util/error.h"
#include "common/util/format.h"
#include "common/util/input_file.h"
#include "common/util/json_file.h"
#include "common/util/quantile.h"

namespace airdos {
namespace {

using nlohmann::json;

constexpr const char* kFigureKeys[kNumRunFigures] = {"ate_m", "rpe_median_m", "rpe_rmse_m",
                                                     "lost_percent"};

/// Sort key: no cap comes last.
int CapOrder(const std::optional<int>& cap) {
  return cap.value_or(std::numeric_limits<int>::max());
}

std::string NameOf(const std::optional<int>& cap) {
  return cap ? std::to_string(*cap) : "uncapped";
}

CappedRun ParseRun(const json& object) {
  CappedRun run;
  run.sequence = object.at("sequence");
  run.mode = object.at("mode");
  const json& cap = object.at("max_observations");
  if (!cap.is_null()) run.cap = static_cast<int>(WholeNumber(cap, 0, 1000000000));
  const double frames = object.at("frames");
  if (!(frames > 0)) throw InputError("key 'frames': must be above 0");
  run.figures = {object.at("ate_m"), object.at("rpe_median_m"), object.at("rpe_rmse_m"),
                 100 * object.at("frames_lost").get<double>() / frames};
  return run;
}

Spread SpreadOf(const std::vector<double>& values) {
  return {Quantile(values, 0.5), Quantile(values, 0.25), Quantile(values, 0.75)};
}

double Ratio(double on, double mask_only) {
  if (mask_only > 0) return on / mask_only;
  return on > 0 ? std::numeric_limits<double>::infinity() : 1;
}

using Pair = std::array<const CappedRun*, 2>;  // {mask_only, on}

HelpPoint MakePoint(const std::optional<int>& cap, const std::vector<Pair>& pairs) {
  HelpPoint point;
  point.cap = cap;
  point.num_sequences = pairs.size();
  for (std::size_t figure = 0; figure < kNumRunFigures; ++figure) {
    std::vector<double> mask_only;
    std::vector<double> on;
    std::vector<double> ratios;
    double sum_mask_only = 0;
    double sum_on = 0;
    for (const Pair& pair : pairs) {
      mask_only.push_back(pair[0]->figures[figure]);
      on.push_back(pair[1]->figures[figure]);
      ratios.push_back(Ratio(on.back(), mask_only.back()));
      sum_mask_only += mask_only.back();
      sum_on += on.back();
    }
    point.mask_only[figure] = SpreadOf(mask_only);
    point.on[figure] = SpreadOf(on);
    point.median_ratio[figure] = SpreadOf(ratios).median;
    point.ratio_of_sums[figure] = Ratio(sum_on, sum_mask_only);
  }
  return point;
}

std::string RunsTable(const HelpCurve& curve) {
  std::string text =
      "| sequence | static features | people | ATE m | RPE-T median m | RPE-T rmse m | lost % |\n"
      "|---|---|---|---|---|---|---|\n";
  for (const CappedRun& run : curve.runs) {
    text += "| " + run.sequence + " | " + NameOf(run.cap) + " | " + run.mode;
    for (std::size_t i = 0; i < 3; ++i) text += Format(" | %.4f", run.figures[i]);
    text += Format(" | %.0f |\n", run.figures[3]);
  }
  return text;
}

std::string PointsTable(const HelpCurve& curve) {
  std::string text =
      "| static features | people | ATE m | RPE-T median m | RPE-T rmse m | lost % |\n"
      "|---|---|---|---|---|---|\n";
  for (const HelpPoint& point : curve.points) {
    for (const auto& [mode, spreads] :
         {std::make_pair("mask_only", point.mask_only), std::make_pair("on", point.on)}) {
      text += "| " + NameOf(point.cap) + " | " + mode;
      for (std::size_t i = 0; i < kNumRunFigures; ++i) {
        const char* const format = i == 3 ? "%.0f" : "%.4f";
        text += " | " + Format(format, spreads[i].median) + " (" +
                Format(format, spreads[i].lower_quartile) + " - " +
                Format(format, spreads[i].upper_quartile) + ")";
      }
      text += " |\n";
    }
  }
  return text;
}

json NumberOrNull(double value) { return std::isfinite(value) ? json(value) : json(nullptr); }

json SpreadsToJson(const std::array<Spread, kNumRunFigures>& spreads) {
  json object;
  for (std::size_t i = 0; i < kNumRunFigures; ++i) {
    object[kFigureKeys[i]] = {{"median", spreads[i].median},
                              {"lower_quartile", spreads[i].lower_quartile},
                              {"upper_quartile", spreads[i].upper_quartile}};
  }
  return object;
}

json FiguresToJson(const RunFigures& figures) {
  json object;
  for (std::size_t i = 0; i < kNumRunFigures; ++i)
    object[kFigureKeys[i]] = NumberOrNull(figures[i]);
  return object;
}

json CapToJson(const std::optional<int>& cap) { return cap ? json(*cap) : json(nullptr); }

}  // namespace

std::vector<CappedRun> ReadCappedRuns(const std::string& path) {
  RequireRegularFile(path);
  std::ifstream file(path);
  if (!file) throw InputError(path + ": cannot be read");
  std::vector<CappedRun> runs;
  std::string line;
  for (int number = 1; std::getline(file, line); ++number) {
    try {
      runs.push_back(ParseRun(json::parse(line)));
    } catch (const std::exception& error) {
      throw InputError(path + ":" + std::to_string(number) + ": " + error.what());
    }
  }
  return runs;
}

HelpCurve ComputeHelpCurve(std::vector<CappedRun> runs) {
  if (runs.empty()) throw InputError("no run at all");
  HelpCurve curve;
  std::sort(runs.begin(), runs.end(), [](const CappedRun& a, const CappedRun& b) {
    return std::make_tuple(a.sequence, CapOrder(a.cap), a.mode) <
           std::make_tuple(b.sequence, CapOrder(b.cap), b.mode);
  });
  curve.runs = std::move(runs);
  std::map<int, std::map<std::string, Pair>> by_cap;
  for (const CappedRun& run : curve.runs) {
    const std::string what =
        "sequence " + run.sequence + ", cap " + NameOf(run.cap) + ", mode '" + run.mode + "': ";
    const bool is_on = run.mode == "on";
    if (!is_on && run.mode != "mask_only") throw InputError(what + "must be mask_only or on");
    const CappedRun*& place = by_cap[CapOrder(run.cap)][run.sequence][is_on ? 1 : 0];
    if (place != nullptr) throw InputError(what + "is there twice");
    place = &run;
  }
  for (const auto& [order, pair_of_sequence] : by_cap) {
    std::vector<Pair> pairs;
    for (const auto& [sequence, pair] : pair_of_sequence) {
      if (pair[0] == nullptr || pair[1] == nullptr) {
        throw InputError("sequence " + sequence + ", cap " +
                         NameOf((pair[0] != nullptr ? pair[0] : pair[1])->cap) + ": no run with " +
                         (pair[0] == nullptr ? "mask_only" : "on") + " to compare with");
      }
      pairs.push_back(pair);
    }
    curve.points.push_back(MakePoint(pairs[0][0]->cap, pairs));
  }
  return curve;
}

std::string ToMarkdown(const HelpCurve& curve) {
  std::string text = RunsTable(curve) + "\nMedian (quartiles) over the sequences:\n\n" +
                     PointsTable(curve) +
                     "\nPeople on / mask_only (below 1: people help), median over the sequences; "
                     "in parentheses sum / sum:\n\n";
  for (const HelpPoint& point : curve.points) {
    text += "- " + NameOf(point.cap) + ", " + std::to_string(point.num_sequences) + " sequences:";
    constexpr const char* kNames[] = {" ATE", ", RPE-T median", ", RPE-T rmse", ", frames lost"};
    for (std::size_t i = 0; i < kNumRunFigures; ++i) {
      text += kNames[i] + Format(" %.2f", point.median_ratio[i]) +
              Format(" (%.2f)", point.ratio_of_sums[i]);
    }
    text += "\n";
  }
  return text;
}

json ToJson(const HelpCurve& curve) {
  json runs = json::array();
  for (const CappedRun& run : curve.runs) {
    json object = FiguresToJson(run.figures);
    object["sequence"] = run.sequence;
    object["mode"] = run.mode;
    object["max_observations"] = CapToJson(run.cap);
    runs.push_back(std::move(object));
  }
  json points = json::array();
  for (const HelpPoint& point : curve.points) {
    points.push_back({{"max_observations", CapToJson(point.cap)},
                      {"sequences", point.num_sequences},
                      {"mask_only", SpreadsToJson(point.mask_only)},
                      {"on", SpreadsToJson(point.on)},
                      {"median_ratio_on_to_mask_only", FiguresToJson(point.median_ratio)},
                      {"ratio_of_sums_on_to_mask_only", FiguresToJson(point.ratio_of_sums)}});
  }
  return {{"runs", runs}, {"points", points}};
}

}  // namespace airdos
