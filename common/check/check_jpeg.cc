#include "common/check/check_jpeg.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "common/util/quantile.h"

namespace airdos {
namespace {

constexpr double kSumOfStandardTable = 3688;  // sum of the 64 entries of table K.1
constexpr int kUsefulQuality = 70;

/// Offset of the 64 entries of quantization table 0 in a JPEG file.
std::optional<std::size_t> FindBrightnessTable(const std::vector<std::uint8_t>& file) {
  constexpr std::uint8_t kTables = 0xDB;
  constexpr std::uint8_t kScan = 0xDA;
  if (file.size() < 4 || file[0] != 0xFF || file[1] != 0xD8) return std::nullopt;
  for (std::size_t at = 2; at + 4 <= file.size() && file[at] == 0xFF && file[at + 1] != kScan;) {
    const std::size_t length = file[at + 2] * 256U + file[at + 3];
    const std::size_t end = at + 2 + length;
    if (length < 2 || end > file.size()) return std::nullopt;
    // 8-bit tables have 65 bytes: the number (and 16 times the precision), then the entries.
    for (std::size_t table = at + 4; file[at + 1] == kTables && table + 65 <= end; table += 65) {
      if (file[table] == 0) return table + 1;
      if (file[table] >= 16) break;
    }
    at = end;
  }
  return std::nullopt;
}

}  // namespace

std::optional<int> JpegQuality(const std::vector<std::uint8_t>& file) {
  const std::optional<std::size_t> table = FindBrightnessTable(file);
  if (!table) return std::nullopt;
  double sum = 0;
  for (std::size_t i = 0; i < 64; ++i) sum += file[*table + i];
  const double scale = 100 * sum / kSumOfStandardTable;  // %
  const double quality = scale <= 100 ? (200 - scale) / 2 : 5000 / scale;
  return static_cast<int>(std::clamp(std::round(quality), 1.0, 100.0));
}

void JpegCheck::Add(const std::vector<std::uint8_t>& file) {
  const std::optional<int> quality = JpegQuality(file);
  if (quality) qualities_.push_back(*quality);
}

void JpegCheck::Report(const std::string& where, FindingList* findings) const {
  if (qualities_.empty()) return;
  const double quality = Quantile(qualities_, 0.5);
  const std::string text = "JPEG quality " + Brief(quality) + " (median)";
  if (quality < kUsefulQuality) {
    findings->Warn("images.jpeg_quality", where,
                   text + ": below " + std::to_string(kUsefulQuality) + " corners suffer");
  } else {
    findings->Note("images.jpeg_quality", where, text);
  }
}

}  // namespace airdos
