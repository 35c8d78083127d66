#ifndef AIRDOS_COMMON_PERCEPTION_TFJS_TO_ONNX_H_
#define AIRDOS_COMMON_PERCEPTION_TFJS_TO_ONNX_H_

#include <string>
#include <vector>

#include "common/perception/tfjs_model.h"

namespace airdos {

/// The part of a model that is wanted. Everything before `input` and after `outputs` is left out:
/// what a model does with its pixels before, and with its results after, is often more than OpenCV
/// can do, and is done by us.
struct TfjsCut {
  std::string input;                 ///< a node; empty: the placeholder of the model
  std::vector<std::string> outputs;  ///< nodes
  /// The image for which it is converted. A network without fixed sizes inside takes others as
  /// well, if they are multiples of its coarsest step.
  int width_px = 256;
  int height_px = 256;
};

/// The part of a TensorFlow.js model as an ONNX file for cv::dnn::readNetFromONNX, whose outputs
/// have the names of the nodes. TensorFlow's tensors are rows x columns x channels, those of ONNX
/// channels x rows x columns. Throws InputError naming node and operation if one of them has no
/// counterpart here.
std::string TfjsToOnnx(const TfjsModel& model, const TfjsCut& cut);

}  // namespace airdos

#endif  // AIRDOS_COMMON_PERCEPTION_TFJS_TO_ONNX_H_
