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

/// Which numbers of a row are what. One of a matrix and a position is there.
struct TrajectoryColumns {
  std::size_t num_columns = 0;
  std::optional<std::size_t> time;
  bool is_matrix = false;  ///< 12 numbers from the first column on: 3 x 4, row major
  std::array<std::size_t, 3> position = {0, 0, 0};
  std::optional<std::array<std::size_t, 4>> quaternion;  ///< where x, y, z and w stand
  QuaternionOrder order = QuaternionOrder::kNone;
  std::string form;  ///< what the file was taken for, empty for TUM and KITTI
};

/// A row's fields, between commas or semicolons where it has any, else between blanks. A field may
/// be empty between two commas. Throws InputError (`where` begins the message) for commas as
/// decimal separators.
std::vector<std::string> SplitFields(const TextLine& line, const std::string& where);

bool IsNumber(const std::string& field);
/// nan, inf, null, none, or an empty field of a csv file: how programs write that there is no pose.
bool IsNoValue(const std::string& field);

/// Finds out the columns from a heading that names them all (in a comment or the first row), else
/// from the count of numbers in the first row: 8 TUM (as EuRoC, w before x, where they stand
/// between commas behind times in ns), 12 KITTI, 16 the same with a last row 0 0 0 1, 17 EuRoC's
/// state_groundtruth, 7 TartanAir (no times), 4 a time and a position. Throws InputError for
/// others.
TrajectoryColumns FindColumns(const std::string& where, const std::string& heading,
                              const std::vector<std::string>& first_row, bool has_commas);

}  // namespace airdos

#endif  // AIRDOS_COMMON_EVALUATION_TRAJECTORY_COLUMNS_H_
