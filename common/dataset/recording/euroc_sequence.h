#ifndef AIRDOS_COMMON_DATASET_RECORDING_EUROC_SEQUENCE_H_
#define AIRDOS_COMMON_DATASET_RECORDING_EUROC_SEQUENCE_H_

#include <memory>
#include <string>

#include "common/dataset/stereo_sequence.h"

namespace airdos {

/// Opens a folder in EuRoC's layout: mav0 below it, or what mav0 holds:
///   cam0/data/ cam1/data/      left and right images, not rectified, with the time (ns) as name
///   cam0/data.csv              rows `time [ns],file name`; without it the names are the times
///   cam0/sensor.yaml cam1/sensor.yaml   the cameras, and their poses T_BS in the body
///   state_groundtruth_estimate0/data.csv   rows `time [ns], position of the body (m), q_w q_x q_y
///                              q_z, ..`; need not be there
/// Images are rectified as they are loaded. The ground truth is that of the rectified left camera,
/// optical axes, in that of its first pose: T_C0_C = (T_W_B0 T_B_C)^-1 T_W_B T_B_C. Between two
/// rows up to 50 ms apart it is interpolated.
///
/// Throws InputError naming the file (and line) that cannot be used.
std::unique_ptr<StereoSequence> OpenEurocSequence(const std::string& folder);

bool IsEurocSequence(const std::string& folder);

}  // namespace airdos

#endif  // AIRDOS_COMMON_DATASET_RECORDING_EUROC_SEQUENCE_H_
