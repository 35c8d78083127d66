#ifndef AIRDOS_COMMON_EVALUATION_TRAJECTORY_COLUMNS_H_
#define AIRDOS_COMMON_EVALUATION_TRAJECTORY_COLUMNS_H_

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "common/evaluation/trajectory.h"
#include "common/util/text_file.h"

namespace airdos {

/// The meaning of the numbers in a row. Has a matrix or a position.
struct TrajectoryColumns {
  std::size_t num_columns = 0;
  std::optional<std::size_t> time;
  bool is_matrix = false;  ///< 12 numbers from the first column on: 3 x 4, row-major
  std::array<std::size_t, 3> position = {0, 0, 0};
  std::optional<std::array<std::size_t, 4>> quaternion;  ///< columns of x, y, z and w
  QuaternionOrder order = QuaternionOrder::kNone;
  std::string form;  ///< the recognised format; empty for TUM and KITTI
};

/// Splits a row at commas or semicolons if it has any, otherwise at blanks. A field between two
/// commas may be empty. Throws InputError (whose message starts with `where`) for decimal commas.
std::vector<std::string> SplitFields(const TextLine& line, const std::string& where);

bool IsNumber(const std::string& field);
/// nan, inf, null, none, or an empty field of a CSV file: how programs denote a missing pose.
bool IsNoValue(const std::string& field);

/// Determines the columns from a heading that names them all (in a comment or the first row),
/// otherwise from the number of fields in the first row: 8 TUM (or EuRoC, with w before x, if they
/// are separated by commas and the times are in ns), 12 KITTI, 16 the same with a last row 0 0 0 1,
/// 17 EuRoC's state_groundtruth, 7 TartanAir (no times), 4 time and position. Throws InputError for
/// anything else.
TrajectoryColumns FindColumns(const std::string& where, const std::string& heading,
                              const std::vector<std::string>& first_row, bool has_commas);

}  // namespace airdos

#endif  // AIRDOS_COMMON_EVALUATION_TRAJECTORY_COLUMNS_H_
