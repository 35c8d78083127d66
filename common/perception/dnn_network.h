#ifndef AIRDOS_COMMON_PERCEPTION_DNN_NETWORK_H_
#define AIRDOS_COMMON_PERCEPTION_DNN_NETWORK_H_

#include <opencv2/core.hpp>
#include <opencv2/dnn.hpp>
#include <string>
#include <vector>

#include "common/perception/tfjs_to_onnx.h"

namespace airdos {

/// A network from a file, and which part of it.
struct DnnNetworkOptions {
  std::string file;  ///< ONNX, or model.json of a TensorFlow.js graph model
  /// Names of the outputs, in the order in which they are wanted; none: all, in the order of their
  /// names (ONNX only).
  std::vector<std::string> outputs;
  std::string input;  ///< of TensorFlow.js: the node where the image comes in; empty: placeholder
};

/// A network run by OpenCV on the CPU. Uses as many threads as cv::setNumThreads() allows; with one
/// the same input gives the same bytes.
class DnnNetwork {
 public:
  /// Throws InputError naming the file if it cannot be used, or has no such output.
  explicit DnnNetwork(const DnnNetworkOptions& options);

  /// The outputs for one input (4 dimensions, CV_32F). Throws InputError naming the file if the
  /// input does not fit, as one of another size may not. An input of another size than the last one
  /// takes as long as the constructor.
  std::vector<cv::Mat> Process(const cv::Mat& blob);

  const std::string& file() const { return file_; }

 private:
  void Read();  ///< the network anew

  std::string file_;
  std::string onnx_;
  cv::dnn::Net net_;
  std::vector<int> input_shape_;  // of the last input
  std::vector<cv::String> outputs_;
};

}  // namespace airdos

#endif  // AIRDOS_COMMON_PERCEPTION_DNN_NETWORK_H_
