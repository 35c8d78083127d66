#include "common/util/suggestion.h"

#include <algorithm>
#include <cctype>
#include <cstddef>

namespace airdos {
namespace {

/// Without leading dashes, in lower case.
std::string Plain(const std::string& word) {
  const std::size_t start = std::min(word.find_first_not_of('-'), word.size());
  std::string plain = word.substr(start);
  for (char& c : plain) {
    c = c == '_' ? '-' : static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  return plain;
}

bool StartsWith(const std::string& text, const std::string& start) {
  return text.compare(0, start.size(), start) == 0;
}

std::string LastPart(const std::string& key) { return key.substr(key.rfind('.') + 1); }

constexpr int kNotNear = 1000;

/// Cost of explaining a word by a candidate; up to MaxCost() counts as similar.
int Cost(const std::string& word, const std::string& candidate) {
  constexpr std::size_t kMinCommonStart = 3;
  const std::string a = Plain(word);
  const std::string b = Plain(candidate);
  const int distance = EditDistance(a, b);
  const bool shares_letters = distance < static_cast<int>(std::max(a.size(), b.size()));
  int cost = shares_letters ? 2 * distance : kNotNear;
  const bool has_common_start =
      std::min(a.size(), b.size()) >= kMinCommonStart && (StartsWith(a, b) || StartsWith(b, a));
  if (has_common_start) cost = std::min(cost, 3);
  if (b.find('.') != std::string::npos && !a.empty() && LastPart(a) == LastPart(b)) {
    cost = std::min(cost, 3);
  }
  return cost;
}

int MaxCost(const std::string& word) {
  const std::size_t size = Plain(word).size();
  return 2 * (size <= 3 ? 1 : size <= 7 ? 2 : 3);
}

}  // namespace

int EditDistance(const std::string& first, const std::string& second) {
  const std::string a = Plain(first);
  const std::string b = Plain(second);
  // distance[i][j]: between the first i letters of a and the first j of b.
  std::vector<std::vector<int>> distance(a.size() + 1, std::vector<int>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) {
    for (std::size_t j = 0; j <= b.size(); ++j) {
      int& best = distance[i][j];
      if (i == 0 || j == 0) {
        best = static_cast<int>(i + j);
        continue;
      }
      best = std::min({distance[i - 1][j] + 1, distance[i][j - 1] + 1,
                       distance[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1)});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        best = std::min(best, distance[i - 2][j - 2] + 1);
      }
    }
  }
  return distance[a.size()][b.size()];
}

std::string DidYouMean(const std::string& word, const std::vector<std::string>& candidates) {
  constexpr std::size_t kMaxWord = 100;  // a longer one is not a mistyped name
  if (Plain(word).empty() || word.size() > kMaxWord) return "";
  const std::string* best = nullptr;
  int best_cost = MaxCost(word) + 1;
  for (const std::string& candidate : candidates) {
    const int cost = Cost(word, candidate);
    if (cost < best_cost) {
      best = &candidate;
      best_cost = cost;
    }
  }
  return best == nullptr ? "" : "; did you mean '" + *best + "'?";
}

}  // namespace airdos
