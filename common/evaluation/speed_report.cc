#include "common/evaluation/speed_report.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <tuple>

#include "common/util/error.h"
#include "common/util/format.h"
#include "common/util/input_file.h"
#include "common/util/json_file.h"

namespace airdos {
namespace {

using nlohmann::json;

std::optional<double> Optional(const json& object, const char* key) {
  if (!object.contains(key) || object[key].is_null()) return std::nullopt;
  return object[key].get<double>();
}

ChainSpeed ParseChain(const json& object) {
  ChainSpeed chain;
  chain.sequence = object.at("sequence");
  chain.num_frames = static_cast<int>(WholeNumber(object.at("num_frames"), 0, 1000000000));
  for (const auto& [name, figures] : object.at("processes").items()) {
    chain.processes[name] = {figures.at("p50_ms"), figures.at("p99_ms"),
                             Optional(figures, "peak_memory_mb")};
  }
  chain.serial_fps = object.at("serial_fps");
  chain.parallel_fps = object.at("parallel_fps");
  chain.replay_memory_mb = object.at("replay_memory_mb");
  chain.live_fps = Optional(object, "live_fps");
  chain.messages_per_s = Optional(object, "messages_per_s");
  return chain;
}

std::vector<std::string> SplitAtSlashes(const std::string& text) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, '/');) parts.push_back(part);
  return parts;
}

double MsPer(const std::string& unit) {
  if (unit == "ns") return 1e-6;
  if (unit == "us") return 1e-3;
  if (unit == "ms") return 1;
  if (unit == "s") return 1e3;
  throw InputError("key 'time_unit' with value '" + unit + "': is none of ns, us, ms, s");
}

std::optional<SolveTime> ParseSolve(const json& object) {
  if (object.contains("error_occurred") && object["error_occurred"].get<bool>())
    return std::nullopt;
  const std::vector<std::string> parts = SplitAtSlashes(object.at("name"));
  SolveTime solve;
  if (parts.size() == 4 && parts[0] == "BM_PaperProblem") {
    solve.problem = parts[1] + "/" + parts[2];
    solve.solver = parts[3];
  } else if (parts.size() == 5 && parts[0] == "BM_Scaling") {
    solve.num_people = std::stoi(parts[1]);
    solve.window = std::stoi(parts[2]);
    solve.solver = parts[3];
    solve.is_warm = parts[4] == "warm";
  } else {
    return std::nullopt;
  }
  const std::optional<double> median_ms = Optional(object, "median_ms");
  solve.cpu_ms =
      median_ms ? *median_ms : object.at("cpu_time").get<double>() * MsPer(object.at("time_unit"));
  solve.iteration_ms = Optional(object, "ms_per_iteration");
  return solve;
}

std::ifstream OpenText(const std::string& path) {
  RequireRegularFile(path);
  std::ifstream file(path);
  if (!file) throw InputError(path + ": cannot be read");
  return file;
}

std::string ToText(const std::optional<double>& value) {
  return value ? Format("%.1f", *value) : std::string("-");
}

std::string ChainTable(const std::vector<ChainSpeed>& chains) {
  std::set<std::string> names;
  for (const ChainSpeed& chain : chains) {
    for (const auto& [name, time] : chain.processes) names.insert(name);
  }
  std::string text = "| sequence | frames |";
  for (const std::string& name : names) text += " " + name + ": ms p50 / p99, MB |";
  text +=
      " replay, 1 thread: frames/s | replay, parallel: frames/s | MB | live: frames/s |"
      " messages/s |\n|---|---|";
  for (std::size_t i = 0; i < names.size() + 5; ++i) text += "---|";
  text += "\n";
  for (const ChainSpeed& chain : chains) {
    text += "| " + chain.sequence + Format(" | %d |", chain.num_frames);
    for (const std::string& name : names) {
      const auto it = chain.processes.find(name);
      if (it == chain.processes.end()) {
        text += " - |";
        continue;
      }
      text += Format(" %.1f / %.1f, ", it->second.p50_ms, it->second.p99_ms) +
              ToText(it->second.peak_memory_mb) + " |";
    }
    text += Format(" %.1f | %.1f | %.0f | ", chain.serial_fps, chain.parallel_fps,
                   chain.replay_memory_mb);
    text += ToText(chain.live_fps) + " | " + ToText(chain.messages_per_s) + " |\n";
  }
  return text;
}

// The conditions under which `solve` was measured, with each solver's figure for them.
using SolveKey = std::tuple<std::string, int, int, bool>;
std::map<SolveKey, std::map<std::string, SolveTime>> BySetting(
    const std::vector<SolveTime>& solves) {
  std::map<SolveKey, std::map<std::string, SolveTime>> table;
  for (const SolveTime& solve : solves) {
    table[{solve.problem, solve.num_people, solve.window, solve.is_warm}][solve.solver] = solve;
  }
  return table;
}

std::string SolveTable(const std::vector<SolveTime>& solves, bool is_paper) {
  std::set<std::string> solvers;
  for (const SolveTime& solve : solves) {
    if (solve.problem.empty() != is_paper) solvers.insert(solve.solver);
  }
  if (solvers.empty()) return "";
  std::string text = is_paper ? "\n| paper's problem |" : "\n| people | window | start |";
  std::string rule = is_paper ? "|---|" : "|---|---|---|";
  for (const std::string& solver : solvers) {
    text += " " + solver + ": ms, ms per iteration |";
    rule += "---|";
  }
  text += "\n" + rule + "\n";
  for (const auto& [key, row] : BySetting(solves)) {
    const auto& [problem, num_people, window, is_warm] = key;
    if (problem.empty() == is_paper) continue;
    text += is_paper ? "| " + problem + " |"
                     : Format("| %d | %d | %s |", num_people, window, is_warm ? "warm" : "cold");
    for (const std::string& solver : solvers) {
      const auto it = row.find(solver);
      text += it == row.end()
                  ? " - |"
                  : Format(" %.2f, ", it->second.cpu_ms) +
                        (it->second.iteration_ms ? Format("%.2f", *it->second.iteration_ms)
                                                 : std::string("-")) +
                        " |";
    }
    text += "\n";
  }
  return text;
}

}  // namespace

std::vector<ChainSpeed> ReadChainSpeeds(const std::string& path) {
  std::ifstream file = OpenText(path);
  std::vector<ChainSpeed> chains;
  std::string line;
  for (int row = 1; std::getline(file, line); ++row) {
    try {
      if (!line.empty()) chains.push_back(ParseChain(json::parse(line)));
    } catch (const json::exception& error) {
      throw InputError(path + ": row " + std::to_string(row) + ": " + error.what());
    }
  }
  return chains;
}

std::vector<SolveTime> ReadSolveTimes(const std::string& path) {
  std::ifstream file = OpenText(path);
  std::vector<SolveTime> solves;
  try {
    const json report = json::parse(file);
    for (const json& object : report.at("benchmarks")) {
      if (const auto solve = ParseSolve(object)) solves.push_back(*solve);
    }
  } catch (const InputError& error) {
    throw InputError(path + ": " + error.what());
  } catch (const std::exception& error) {  // from the JSON, or from a number in a name
    throw InputError(path + ": is not a Google Benchmark report: " + error.what());
  }
  return solves;
}

std::string ToMarkdown(const std::vector<ChainSpeed>& chains,
                       const std::vector<SolveTime>& solves) {
  return (chains.empty() ? "" : ChainTable(chains)) + SolveTable(solves, true) +
         SolveTable(solves, false);
}

json ToJson(const std::vector<ChainSpeed>& chains, const std::vector<SolveTime>& solves) {
  const auto to_json = [](const std::optional<double>& value) {
    return value ? json(*value) : json(nullptr);
  };
  json result{{"sequences", json::array()}, {"solves", json::array()}};
  for (const ChainSpeed& chain : chains) {
    json row{{"sequence", chain.sequence},
             {"num_frames", chain.num_frames},
             {"serial_fps", chain.serial_fps},
             {"parallel_fps", chain.parallel_fps},
             {"replay_memory_mb", chain.replay_memory_mb},
             {"live_fps", to_json(chain.live_fps)},
             {"messages_per_s", to_json(chain.messages_per_s)}};
    for (const auto& [name, time] : chain.processes) {
      row["processes"][name] = {{"p50_ms", time.p50_ms},
                                {"p99_ms", time.p99_ms},
                                {"peak_memory_mb", to_json(time.peak_memory_mb)}};
    }
    result["sequences"].push_back(row);
  }
  for (const SolveTime& solve : solves) {
    json row{{"solver", solve.solver},
             {"cpu_ms", solve.cpu_ms},
             {"iteration_ms", to_json(solve.iteration_ms)}};
    if (solve.problem.empty()) {
      row["num_people"] = solve.num_people;
      row["window"] = solve.window;
      row["start"] = solve.is_warm ? "warm" : "cold";
    } else {
      row["problem"] = solve.problem;
    }
    result["solves"].push_back(row);
  }
  return result;
}

}  // namespace airdos
