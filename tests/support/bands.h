#ifndef AIRDOS_TESTS_SUPPORT_BANDS_H_
#define AIRDOS_TESTS_SUPPORT_BANDS_H_

#include <gtest/gtest.h>

#include <fstream>
#include <iostream>
#include <map>
#include <sstream>
#include <string>
#include <utility>

namespace airdos {

/// The figures measured in one case, by name.
using Figures = std::map<std::string, double>;

/// Compares figures with tests/dataset/bands.txt (lines `case figure least most`; `#` starts a
/// comment): each figure must have a band and be inside it, and each band of the case must have its
/// figure. Prints them in the format that tests/dataset/make_bands.sh reads. `name` must not
/// contain spaces.
inline void ExpectInBands(const std::string& name, const Figures& figures) {
  std::map<std::string, std::pair<double, double>> bands;
  std::ifstream file(AIRDOS_SOURCE_DIR "/tests/dataset/bands.txt");
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::string of, figure;
    double least = 0, most = 0;
    if (line.empty() || line[0] == '#') continue;
    ASSERT_TRUE(words >> of >> figure >> least >> most) << line;
    if (of == name) bands[figure] = {least, most};
  }
  for (const auto& [figure, value] : figures) {
    std::cout << "figure: " << name << " " << figure << " " << value << "\n";
    const auto band = bands.find(figure);
    if (band == bands.end()) {
      ADD_FAILURE() << name << " " << figure << " has no band";
      continue;
    }
    EXPECT_GE(value, band->second.first) << name << " " << figure;
    EXPECT_LE(value, band->second.second) << name << " " << figure;
    bands.erase(band);
  }
  for (const auto& [figure, band] : bands) ADD_FAILURE() << name << " " << figure << " is missing";
}

}  // namespace airdos

#endif  // AIRDOS_TESTS_SUPPORT_BANDS_H_
