#include "common/perception/dnn_network.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <opencv2/core/utils/logger.hpp>

#include "common/util/error.h"
#include "common/util/input_file.h"
#include "common/util/suggestion.h"
#include "common/util/text_file.h"

namespace airdos {
namespace {

/// OpenCV also writes on stderr what it throws; the exception is enough.
class QuietOpenCv {
 public:
  QuietOpenCv() : before_(cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT)) {}
  ~QuietOpenCv() { cv::utils::logging::setLogLevel(before_); }
  QuietOpenCv(const QuietOpenCv&) = delete;
  QuietOpenCv& operator=(const QuietOpenCv&) = delete;

 private:
  cv::utils::logging::LogLevel before_;
};

/// Its first line, without OpenCV's own place in its code.
std::string Reason(const cv::Exception& error) {
  std::string text = error.err.substr(0, error.err.find('\n'));
  if (text.size() > 200) text.resize(200);
  return Printable(text);
}

std::string OnnxBytes(const DnnNetworkOptions& options) {
  const std::string& file = options.file;
  if (std::filesystem::path(file).extension() == ".json") {
    if (options.outputs.empty()) throw InputError(file + ": needs the names of its outputs");
    TfjsCut cut;
    cut.input = options.input;
    cut.outputs = options.outputs;
    const TfjsModel model = ReadTfjsModel(file);
    try {
      return TfjsToOnnx(model, cut);
    } catch (const InputError& error) {
      throw InputError(file + ": " + error.what());
    }
  }
  RequireRegularFile(file);
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

}  // namespace

void DnnNetwork::Read() {
  net_ = cv::dnn::readNetFromONNX(onnx_.data(), onnx_.size());
  net_.setPreferableBackend(cv::dnn::DNN_BACKEND_OPENCV);
  net_.setPreferableTarget(cv::dnn::DNN_TARGET_CPU);
}

DnnNetwork::DnnNetwork(const DnnNetworkOptions& options)
    : file_(options.file), onnx_(OnnxBytes(options)) {
  const QuietOpenCv quiet;
  try {
    if (onnx_.empty()) throw InputError(file_ + ": is empty");
    Read();
    const std::vector<cv::String> known = net_.getUnconnectedOutLayersNames();
    outputs_.assign(options.outputs.begin(), options.outputs.end());
    if (outputs_.empty()) {
      outputs_ = known;
      std::sort(outputs_.begin(), outputs_.end());
    }
    for (const std::string& name : outputs_) {
      if (net_.getLayerId(name) >= 0 || std::count(known.begin(), known.end(), name) > 0) continue;
      throw InputError(file_ + ": has no output '" + name + "'" +
                       DidYouMean(name, {known.begin(), known.end()}));
    }
  } catch (const cv::Exception& error) {
    throw InputError(file_ + ": OpenCV cannot read this network: " + Reason(error));
  }
}

std::vector<cv::Mat> DnnNetwork::Process(const cv::Mat& blob) {
  const QuietOpenCv quiet;
  std::vector<cv::Mat> results;
  try {
    // OpenCV 4.6 gives wrong results where a network's input changes its size.
    const std::vector<int> shape(blob.size.p, blob.size.p + blob.dims);
    if (!input_shape_.empty() && shape != input_shape_) Read();
    input_shape_ = shape;
    net_.setInput(blob);
    net_.forward(results, outputs_);
  } catch (const cv::Exception& error) {
    throw InputError(file_ + ": the network cannot be run on an image of " +
                     std::to_string(blob.size[3]) + " x " + std::to_string(blob.size[2]) + ": " +
                     Reason(error));
  }
  // They are the network's own, and the next image would overwrite them.
  for (cv::Mat& result : results) result = result.clone();
  return results;
}

}  // namespace airdos
