// Networks from files: ONNX, TensorFlow.js, and what is neither.
#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>

#include "common/perception/dnn_network.h"
#include "common/perception/network_input.h"
#include "common/perception/onnx_writer.h"
#include "tests/support/input_errors.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/tiny_networks.h"

namespace airdos {
namespace {

using nlohmann::json;

// --- the input
TEST(NetworkInputTest, TheSizeFollowsTheShapeOfTheImage) {
  EXPECT_EQ(ChooseInputSize({640, 360}, 288, 32), cv::Size(512, 288));
  EXPECT_EQ(ChooseInputSize({640, 360}, 224, 32), cv::Size(416, 224));
  EXPECT_EQ(ChooseInputSize({1242, 375}, 288, 32), cv::Size(960, 288));
  EXPECT_EQ(ChooseInputSize({360, 640}, 288, 32), cv::Size(288, 512));
  EXPECT_EQ(ChooseInputSize({100, 60}, 288, 32), cv::Size(128, 64));  // not larger than it is
  EXPECT_EQ(ChooseInputSize({640, 360}, 10, 32), cv::Size(32, 32));
}

TEST(NetworkInputTest, TheImageKeepsItsShape) {
  const cv::Mat image(30, 60, CV_8UC3, cv::Scalar(10, 20, 30));
  InputPlace place;
  cv::Mat input = FitIntoInput(image, {120, 100}, Fill::kBelowAndRight, &place);
  EXPECT_EQ(input.size(), cv::Size(120, 100));
  EXPECT_EQ(place.scale, 2);
  EXPECT_EQ(input.at<cv::Vec3b>(59, 119), cv::Vec3b(10, 20, 30));
  EXPECT_EQ(input.at<cv::Vec3b>(60, 0), cv::Vec3b(0, 0, 0));
  input = FitIntoInput(image, {120, 100}, Fill::kAround, &place);
  EXPECT_EQ(place.offset_px, cv::Point2d(0, 20));
  EXPECT_EQ(input.at<cv::Vec3b>(19, 0), cv::Vec3b(114, 114, 114));
  EXPECT_EQ(input.at<cv::Vec3b>(20, 0), cv::Vec3b(10, 20, 30));
  EXPECT_EQ(place.ToImage(8, 24), cv::Point2d(4, 2));
}

TEST(NetworkInputTest, GreyLevelsBecomeTheNumbersOfTheNetwork) {
  NetworkInputOptions options;
  options.mean_red = 1;
  options.mean_green = 2;
  options.mean_blue = 3;
  options.scale_red = 2;
  options.scale_green = 4;
  options.scale_blue = 8;
  const cv::Mat image(2, 5, CV_8UC3, cv::Scalar(103, 102, 101));  // blue, green, red
  const cv::Mat first = ToBlob(options, image);
  ASSERT_EQ(first.dims, 4);
  EXPECT_EQ(first.size[1], 3);
  EXPECT_EQ(first.size[2], 2);
  EXPECT_EQ(first.size[3], 5);
  EXPECT_FLOAT_EQ(*first.ptr<float>(0, 0), 50);
  EXPECT_FLOAT_EQ(*first.ptr<float>(0, 1), 25);
  EXPECT_FLOAT_EQ(*first.ptr<float>(0, 2), 12.5);
  options.layout = NetworkInputOptions::Layout::kChannelsLast;
  options.colours = NetworkInputOptions::Colours::kBgr;
  const cv::Mat last = ToBlob(options, image);
  EXPECT_EQ(last.size[1], 2);
  EXPECT_EQ(last.size[3], 3);
  const auto* values = last.ptr<float>();
  EXPECT_FLOAT_EQ(values[0], 12.5);
  EXPECT_FLOAT_EQ(values[2], 50);
}

// --- ONNX
cv::Mat Blob(const std::vector<float>& values, int channels, int rows, int columns) {
  const int shape[] = {1, channels, rows, columns};
  return cv::Mat(4, shape, CV_32F, const_cast<float*>(values.data())).clone();
}

TEST(DnnNetworkTest, SaysWhatIsWrongWithAFile) {
  const ScratchFolder scratch("dnn_network");
  const auto error_of = [&](const std::string& content, std::vector<std::string> outputs = {}) {
    return ErrorOf([&] { DnnNetwork({scratch.Write("n.onnx", content), outputs, ""}); });
  };
  EXPECT_TRUE(Holds(ErrorOf([&] {
                      DnnNetwork({scratch.PathOf("none.onnx"), {}, ""});
                    }),
                    "none.onnx"));
  EXPECT_TRUE(Holds(error_of(""), "n.onnx: is empty"));
  EXPECT_TRUE(Holds(error_of("no network"), "n.onnx: OpenCV cannot read this network"));
  const std::string network = TinyMask({8, 4});
  EXPECT_EQ(error_of(network), "");
  EXPECT_TRUE(Holds(error_of(network.substr(0, network.size() / 2)), "cannot read this network"));
  EXPECT_TRUE(Holds(error_of(network, {"mesk"}), "has no output 'mesk'; did you mean 'mask'?"));
  OnnxWriter unknown;
  unknown.AddNode({"NoSuchThing", {"image"}, "result"});
  EXPECT_TRUE(Holds(error_of(unknown.Bytes({"image", {1, 3, 4, 4}}, {{"result", {1, 3, 4, 4}}})),
                    "cannot read this network"));
}

TEST(DnnNetworkTest, ResultsStayWhenTheNextImageComes) {
  const ScratchFolder scratch("dnn_network_results");
  DnnNetwork network({scratch.Write("n.onnx", TinyMask({2, 1})), {}, ""});
  const std::vector<cv::Mat> first = network.Process(Blob({1, 2, 0, 0, 0, 0}, 3, 1, 2));
  network.Process(Blob({5, 6, 0, 0, 0, 0}, 3, 1, 2));
  ASSERT_EQ(first.size(), 1u);
  EXPECT_EQ(first[0].ptr<float>()[0], 1);
  EXPECT_EQ(first[0].ptr<float>()[1], 2);
}

// --- TensorFlow.js
json Wholes(const std::vector<int>& values) {
  json list = json::array();
  for (const int value : values) list.push_back(std::to_string(value));
  return {{"list", {{"i", list}}}};
}
const json kSame = {{"s", "U0FNRQ=="}};
const json kValid = {{"s", "VkFMSUQ="}};

/// A model that is written to a folder.
class Model {
 public:
  Model() { AddNode("image", "Placeholder", {}); }

  void AddNode(const std::string& name, const std::string& op,
               const std::vector<std::string>& inputs, const json& attributes = json::object()) {
    nodes_.push_back({{"name", name}, {"op", op}, {"input", inputs}, {"attr", attributes}});
  }
  void AddWeights(const std::string& name, const std::vector<int>& shape,
                  const std::vector<float>& values) {
    weights_.push_back({{"name", name}, {"shape", shape}, {"dtype", "float32"}});
    Append(values.data(), values.size() * sizeof(float));
  }
  template <class Number>
  void AddQuantized(const std::string& name, const std::vector<int>& shape, const json& how,
                    const std::vector<Number>& values) {
    weights_.push_back(
        {{"name", name}, {"shape", shape}, {"dtype", "float32"}, {"quantization", how}});
    Append(values.data(), values.size() * sizeof(Number));
  }
  /// Of the network cut out of it.
  cv::Mat Run(const ScratchFolder& scratch, const cv::Mat& blob, const std::string& output,
              const std::string& input = "") const {
    DnnNetwork network({Write(scratch), {output}, input});
    return network.Process(blob)[0];
  }
  std::string Write(const ScratchFolder& scratch) const {
    scratch.Write("weights.bin", bytes_);
    const json file = {{"modelTopology", {{"node", nodes_}}},
                       {"weightsManifest", {{{"paths", {"weights.bin"}}, {"weights", weights_}}}}};
    return scratch.Write("model.json", file.dump());
  }

 private:
  void Append(const void* data, std::size_t size) {
    bytes_.append(static_cast<const char*>(data), size);
  }
  json nodes_ = json::array();
  json weights_ = json::array();
  std::string bytes_;
};

/// Red is 10 * row + column, green and blue are 0.
cv::Mat Ramp(int rows, int columns) {
  cv::Mat blob =
      Blob(std::vector<float>(static_cast<std::size_t>(3 * rows * columns), 0), 3, rows, columns);
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column)
      blob.ptr<float>(0, 0)[row * columns + column] = static_cast<float>(10 * row + column);
  }
  return blob;
}

std::vector<float> ValuesOf(const cv::Mat& output) {
  return {output.ptr<float>(), output.ptr<float>() + output.total()};
}

/// Weights of a 3 x 3 kernel from three colours to one channel: `value` for red at a place.
std::vector<float> Kernel(int row, int column, float value) {
  std::vector<float> weights(27, 0);
  weights[static_cast<std::size_t>((3 * row + column) * 3)] = value;
  return weights;
}

class TfjsTest : public ::testing::Test {
 protected:
  ScratchFolder scratch_{"tfjs"};
  Model model_;
};

TEST_F(TfjsTest, StridesOfTwoPadBelowAndRightOnly) {
  model_.AddWeights("first", {3, 3, 3, 1}, Kernel(0, 0, 1));
  model_.AddWeights("last", {3, 3, 3, 1}, Kernel(2, 2, 1));
  const json how = {{"strides", Wholes({1, 2, 2, 1})}, {"padding", kSame}};
  model_.AddNode("a", "Conv2D", {"image", "first"}, how);
  model_.AddNode("b", "Conv2D", {"image", "last"}, how);
  EXPECT_EQ(ValuesOf(model_.Run(scratch_, Ramp(4, 4), "a")), (std::vector<float>{0, 2, 20, 22}));
  EXPECT_EQ(ValuesOf(model_.Run(scratch_, Ramp(4, 4), "b")), (std::vector<float>{22, 0, 0, 0}));
}

TEST_F(TfjsTest, StridesOfOnePadAround) {
  model_.AddWeights("first", {3, 3, 3, 1}, Kernel(0, 0, 1));
  model_.AddNode("same", "Conv2D", {"image", "first"},
                 {{"strides", Wholes({1, 1, 1, 1})}, {"padding", kSame}});
  model_.AddNode("valid", "Conv2D", {"image", "first"},
                 {{"strides", Wholes({1, 1, 1, 1})}, {"padding", kValid}});
  EXPECT_EQ(ValuesOf(model_.Run(scratch_, Ramp(3, 3), "same")),
            (std::vector<float>{0, 0, 0, 0, 0, 1, 0, 10, 11}));
  EXPECT_EQ(ValuesOf(model_.Run(scratch_, Ramp(3, 4), "valid")), (std::vector<float>{0, 1}));
}

TEST_F(TfjsTest, FusedStepsFollowAConvolution) {
  model_.AddWeights("weights", {3, 3, 3, 1}, Kernel(1, 1, 1));
  model_.AddWeights("bias", {1}, {-2});
  json how = {{"strides", Wholes({1, 1, 1, 1})}, {"padding", kSame}};
  how["fused_ops"] = {{"list", {{"s", {"Qmlhc0FkZA==", "UmVsdTY="}}}}};  // BiasAdd, Relu6
  model_.AddNode("a", "_FusedConv2D", {"image", "weights", "bias"}, how);
  EXPECT_EQ(ValuesOf(model_.Run(scratch_, Ramp(2, 4), "a")),
            (std::vector<float>{0, 0, 0, 1, 6, 6, 6, 6}));
}

TEST_F(TfjsTest, EachChannelHasItsOwnKernelInDepth) {
  model_.AddWeights("spread", {1, 1, 3, 2}, {1, 2, 0, 0, 0, 0});  // of red once and twice
  model_.AddWeights("each", {1, 1, 2, 2}, {1, 10, 100, 1000});
  const json how = {{"strides", Wholes({1, 1, 1, 1})}, {"padding", kValid}};
  model_.AddNode("two", "Conv2D", {"image", "spread"}, how);
  model_.AddNode("four", "DepthwiseConv2dNative", {"two", "each"}, how);
  EXPECT_EQ(ValuesOf(model_.Run(scratch_, Ramp(1, 2), "four")),
            (std::vector<float>{0, 1, 0, 10, 0, 200, 0, 2000}));
}

/// red, enlarged twice by what the model computes from its shape
void AddEnlarged(Model* model) {
  model->AddWeights("red", {1, 1, 3, 1}, {1, 0, 0});
  model->AddWeights("begin", {1}, {1});
  model->AddWeights("end", {1}, {3});
  model->AddWeights("step", {1}, {1});
  model->AddWeights("two", {2}, {2, 2});
  model->AddNode("r", "Conv2D", {"image", "red"},
                 {{"strides", Wholes({1, 1, 1, 1})}, {"padding", kValid}});
  model->AddNode("shape", "Shape", {"r"});
  model->AddNode("rows_columns", "StridedSlice", {"shape", "begin", "end", "step"});
  model->AddNode("size", "Mul", {"rows_columns", "two"});
  model->AddNode("large", "ResizeBilinear", {"r", "size"},
                 {{"half_pixel_centers", {{"b", true}}}, {"align_corners", {{"b", false}}}});
}

TEST_F(TfjsTest, ImagesAreEnlargedAboutTheMiddlesOfPixels) {
  AddEnlarged(&model_);
  const std::vector<float> values = ValuesOf(model_.Run(scratch_, Ramp(1, 2), "large"));
  ASSERT_EQ(values.size(), 8u);
  const std::vector<float> expected{0, 0.25, 0.75, 1};
  for (std::size_t i = 0; i < 8; ++i) EXPECT_FLOAT_EQ(values[i], expected[i % 4]);
}

TEST_F(TfjsTest, OneConversionServesImagesOfAllSizes) {
  AddEnlarged(&model_);
  for (const int rows : {2, 64, 300}) {
    const cv::Mat large = model_.Run(scratch_, Ramp(rows, 6), "large");
    EXPECT_EQ(large.size[2], 2 * rows);
    EXPECT_EQ(large.size[3], 12);
  }
}

TEST_F(TfjsTest, SumsProductsAndMeans) {
  model_.AddWeights("per_channel", {3}, {1, 2, 3});
  model_.AddWeights("half", {}, {0.5});
  model_.AddNode("sum", "Add", {"image", "per_channel"});
  model_.AddNode("scaled", "Mul", {"half", "sum"});
  model_.AddNode("twice", "AddV2", {"scaled", "scaled"});
  model_.AddNode("mean", "AvgPool", {"twice"},
                 {{"ksize", Wholes({1, 256, 256, 1})},
                  {"strides", Wholes({1, 256, 256, 1})},
                  {"padding", kValid}});
  model_.AddNode("likely", "Sigmoid", {"mean"});
  EXPECT_EQ(ValuesOf(model_.Run(scratch_, Ramp(1, 2), "twice")),
            (std::vector<float>{1, 2, 2, 2, 3, 3}));
  const std::vector<float> mean = ValuesOf(model_.Run(scratch_, Ramp(256, 256), "mean"));
  ASSERT_EQ(mean.size(), 3u);
  EXPECT_NEAR(mean[0], 1 + 11 * 127.5, 0.5);  // a sum of 65,536 floats
  EXPECT_NEAR(mean[1], 2, 1e-5);
}

TEST_F(TfjsTest, TransposedConvolutionsEnlarge) {
  model_.AddWeights("size", {4}, {1, 512, 512, 2});
  // rows x columns x out x in: red to the first channel at (0, 1), to the second at (1, 0)
  std::vector<float> weights(2 * 2 * 2 * 3, 0);
  weights[static_cast<std::size_t>(((0 * 2 + 1) * 2 + 0) * 3)] = 1;
  weights[static_cast<std::size_t>(((1 * 2 + 0) * 2 + 1) * 3)] = 3;
  model_.AddWeights("weights", {2, 2, 2, 3}, weights);
  model_.AddNode("large", "Conv2DBackpropInput", {"size", "weights", "image"},
                 {{"strides", Wholes({1, 2, 2, 1})}, {"padding", kSame}});
  EXPECT_EQ(ValuesOf(model_.Run(scratch_, Ramp(1, 2), "large")),
            (std::vector<float>{0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 3, 0}));
}

TEST_F(TfjsTest, WeightsMayBeStoredInFewerBits) {
  const json half = {{"dtype", "float16"}};
  model_.AddQuantized<cv::float16_t>("half", {3}, half,
                                     {cv::float16_t(0.5F), cv::float16_t(-2), cv::float16_t(3)});
  const json byte = {{"dtype", "uint8"}, {"scale", 0.5}, {"min", -1.0}};
  model_.AddQuantized<std::uint8_t>("byte", {3}, byte, {0, 2, 10});
  model_.AddNode("a", "Mul", {"image", "half"});
  model_.AddNode("b", "Add", {"a", "byte"});
  const cv::Mat ones = Blob({1, 1, 1}, 3, 1, 1);
  EXPECT_EQ(ValuesOf(model_.Run(scratch_, ones, "b")), (std::vector<float>{-0.5, -2, 7}));
}

TEST_F(TfjsTest, TheInputMayBeAnyNode) {
  model_.AddWeights("two", {}, {2});
  model_.AddNode("prepared", "CannotBeDone", {"image"});
  model_.AddNode("result", "Mul", {"prepared", "two"});
  EXPECT_EQ(ValuesOf(model_.Run(scratch_, Blob({1, 2, 3}, 3, 1, 1), "result", "prepared")),
            (std::vector<float>{2, 4, 6}));
  EXPECT_TRUE(Holds(ErrorOf([&] { model_.Run(scratch_, Ramp(1, 1), "result"); }),
                    "model.json: node 'prepared' (CannotBeDone): this operation is not supported"));
}

TEST_F(TfjsTest, SaysWhatIsWrongWithAModel) {
  const auto error_of = [&](const std::string& output, const std::string& input = "") {
    return ErrorOf([&] { model_.Run(scratch_, Ramp(4, 4), output, input); });
  };
  model_.AddNode("loop", "Relu", {"loop"});
  model_.AddNode("few", "Relu", {});
  model_.AddNode("two", "Conv2D", {"image", "missing"});
  EXPECT_TRUE(Holds(error_of("nowhere"), "the model has no node 'nowhere'"));
  EXPECT_TRUE(Holds(error_of("few", "nowhere"), "the model has no node 'nowhere'"));
  EXPECT_TRUE(Holds(error_of("loop"), "node 'loop' (Relu): depends on itself"));
  EXPECT_TRUE(Holds(error_of("few"), "node 'few' (Relu): has too few inputs"));
  EXPECT_TRUE(Holds(error_of("two"), "its input 1 is no constant"));
  EXPECT_TRUE(Holds(ErrorOf([&] {
                      DnnNetwork({scratch_.Write("other.json", "{\"a\": 1}"), {"x"}, ""});
                    }),
                    "other.json: is not a TensorFlow.js graph model"));
  EXPECT_TRUE(Holds(ErrorOf([&] {
                      DnnNetwork({model_.Write(scratch_), {}, ""});
                    }),
                    "needs the names of its outputs"));
  model_.AddWeights("long", {4}, {1, 2, 3});
  EXPECT_TRUE(Holds(error_of("few"), "model.json: its weights are cut short"));
}

}  // namespace
}  // namespace airdos
