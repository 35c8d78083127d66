#include "processes/person_detector/person_detector_options.h"

#include <filesystem>
#include <string>
#include <system_error>

#include "common/util/error.h"

namespace airdos {
namespace {

using Head = PersonDetectorOptions::Head;
using Right = PersonDetectorOptions::Right;
using Layout = NetworkInputOptions::Layout;
using Colours = NetworkInputOptions::Colours;

/// Where fetch_networks.sh puts them, beside the installed programs or in the build folder.
std::string FetchedNetwork(const std::string& name) {
  std::error_code ignored;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", ignored);
  const std::filesystem::path installed =
      program.parent_path().parent_path() / "share" / "airdos" / "networks" / name;
  if (std::filesystem::exists(installed, ignored)) return installed.string();
  return std::string(AIRDOS_BUILD_NETWORKS_DIR) + "/" + name;
}

/// Sets what is empty to the fetched network, if `network` has no file.
void UseFetched(const std::string& key, const DnnNetworkOptions& fetched,
                DnnNetworkOptions* network) {
  if (!network->file.empty()) return;
  network->file = FetchedNetwork(fetched.file);
  if (network->input.empty()) network->input = fetched.input;
  if (network->outputs.empty()) network->outputs = fetched.outputs;
  std::error_code ignored;
  if (std::filesystem::exists(network->file, ignored)) return;
  throw InputError(network->file +
                   ": the network is not there; launch_scripts/fetch_networks.sh fetches it, or "
                   "set person_detector:" +
                   key);
}

DnnNetworkOptions FetchedMoveNet() {
  const std::string part = "StatefulPartitionedCall/";
  return {"movenet-multipose.json",
          {part + "center_0/conv2d_4/BiasAdd", part + "kpt_heatmap_0/conv2d_7/BiasAdd",
           part + "kpt_regress_0/conv2d_8/BiasAdd", part + "kpt_offset_0/conv2d_9/BiasAdd"},
          part + "sub_1"};
}

void AddNetwork(const std::string& section, PoseNetworkOptions* options, OptionTable* table) {
  const auto key = [&section](const char* name) { return section + "." + name; };
  NetworkInputOptions* input = &options->input;
  table->Add(key("input"), &options->network.input,
             "node of a TensorFlow.js model where the image comes in; empty: its placeholder");
  table->Add(key("outputs"), &options->network.outputs,
             "names of the outputs, separated by commas; MoveNet: centre, heatmaps, regression, "
             "offsets; empty: all of an ONNX file, those of the fetched network");
  table->Add(key("width_px"), &input->width_px, {0, 4096}, "px",
             "of the input; 0, and 0 as height: by the shape of the images");
  table->Add(key("height_px"), &input->height_px, {0, 4096}, "px", "of the input");
  table->Add(key("short_side_px"), &options->short_side_px, {32, 4096}, "px",
             "shorter side of an input that goes by the shape of the images: time grows with its "
             "square, and so does the number of small people that are found");
  table->AddChoice<Layout>(key("layout"), &input->layout,
                           {{"channels_first", Layout::kChannelsFirst, "1 x 3 x rows x columns"},
                            {"channels_last", Layout::kChannelsLast, "1 x rows x columns x 3"}});
  table->AddChoice<Colours>(
      key("colours"), &input->colours,
      {{"rgb", Colours::kRgb, "red first"}, {"bgr", Colours::kBgr, "blue first"}});
  const Range grey{0, 255};
  const std::string mean = "subtracted from the grey levels of this colour";
  table->Add(key("mean_red"), &input->mean_red, grey, "", mean);
  table->Add(key("mean_green"), &input->mean_green, grey, "", mean);
  table->Add(key("mean_blue"), &input->mean_blue, grey, "", mean);
  const std::string scale = "by which they are divided then";
  const Range scales{0.001, 255};
  table->Add(key("scale_red"), &input->scale_red, scales, "", scale);
  table->Add(key("scale_green"), &input->scale_green, scales, "", scale);
  table->Add(key("scale_blue"), &input->scale_blue, scales, "", scale);
  table->Add(key("min_score"), &options->min_score, {0.001, 1}, "0..1",
             "people who are less certain are left out");
  table->Add(key("max_overlap"), &options->max_overlap, {0, 1}, "0..1",
             "two boxes that have a larger part in common are one person");
  table->Add(key("max_people"), &options->max_people, {1, 200}, "people",
             "in one image, the most certain ones");
}

void AddStereo(PersonDetectorOptions* options, OptionTable* table) {
  table->AddSection("joints");
  table->AddShared("joints.min_score",
                   {&options->min_joint_score, &options->rows.min_score, &options->masks.min_score},
                   {0.001, 1}, "0..1", "joints below it count as not seen");
  table->Add("joints.min_number", &options->min_joints, {1, kNumPoseJoints}, "joints",
             "people of whom fewer are seen are left out");
  table->AddSection("stereo");
  table->AddChoice<Right>(
      "stereo.right", &options->right,
      {{"network", Right::kNetwork, "the network finds the people of the right image, too"},
       {"rows", Right::kRows, "each joint of the left image is looked for along its row"}});
  table->AddSection("time");
  table->Add("time.detect_every", &options->detect_every, {1, 100}, "images",
             "the network looks at every so many; between, joints are followed by optical flow");
}

void AddMasks(PersonDetectorOptions* options, OptionTable* table) {
  PersonMaskerOptions* masks = &options->masks;
  table->AddSection("masks");
  table->Add("masks.use", &options->use_masks,
             "publish masks; without, others draw their own around the joints");
  table->Add("masks.use_network", &masks->use_network,
             "a network marks people who are large enough; without, the joints alone");
  table->Add("masks.file", &masks->network.file, "of that network; empty: the fetched one");
  table->Add("masks.input", &masks->network.input,
             "node of a TensorFlow.js model where the image comes in; empty: its placeholder");
  table->Add("masks.outputs", &masks->network.outputs, "name of its output");
  table->Add("masks.side_px", &masks->side_px, {32, 1024}, "px", "of its input, a square");
  table->Add("masks.image_short_side_px", &masks->image_short_side_px, {0, 1024}, "px",
             "shorter side of its input when it looks at the whole image, for people who are near; "
             "0: it does not");
  table->Add("masks.min_height_px", &masks->min_height_px, {1, 10000}, "px",
             "people who are smaller are marked by their joints alone");
}

}  // namespace

OptionTable TableOf(PersonDetectorOptions* options) {
  OptionTable table(
      "person_detector",
      "airdos-person-detector: stereo images -> joints of people in both, and a mask "
      "of the left one. The networks are fetched by launch_scripts/fetch_networks.sh, "
      "or are files of yours (ONNX, or a TensorFlow.js graph model).");
  table.AddSection("network");
  table.AddChoice<Head>(
      "network.head", &options->head,
      {{"movenet", Head::kMoveNet, "heads of MoveNet MultiPose"},
       {"yolo", Head::kYolo, "a list of people with joints, as YOLO has it"},
       {"simcc", Head::kSimcc, "SimCC, as RTMPose has it, within the boxes of another network"}});
  table.Add("network.file", &options->pose.network.file,
            "ONNX, or model.json of TensorFlow.js; empty: the fetched MoveNet MultiPose");
  AddNetwork("network", &options->pose, &table);
  table.AddSection("boxes", "The network that finds the boxes for simcc: a list as YOLO has it.");
  table.Add("boxes.file", &options->boxes.network.file, "ONNX, or model.json of TensorFlow.js");
  AddNetwork("boxes", &options->boxes, &table);
  AddStereo(options, &table);
  AddMasks(options, &table);
  return table;
}

PersonDetectorOptions ReadPersonDetectorOptions(ConfigReader* config) {
  auto options = ReadOptions<PersonDetectorOptions>(config);
  if ((options.pose.input.width_px == 0) != (options.pose.input.height_px == 0))
    throw InputError("person_detector: network.width_px and network.height_px: one of them is 0");
  if ((options.boxes.input.width_px == 0) != (options.boxes.input.height_px == 0))
    throw InputError("person_detector: boxes.width_px and boxes.height_px: one of them is 0");
  if (options.head == Head::kMoveNet)
    UseFetched("network.file to one of your own", FetchedMoveNet(), &options.pose.network);
  if (options.pose.network.file.empty())
    throw InputError("person_detector: network.file: is empty; this head needs a file of yours");
  if (options.head == Head::kSimcc && options.boxes.network.file.empty())
    throw InputError("person_detector: boxes.file: is empty; simcc needs a network of boxes");
  if (options.use_masks && options.masks.use_network)
    UseFetched("masks.use_network=false", {"selfie.json", {"activation_10"}, ""},
               &options.masks.network);
  return options;
}

}  // namespace airdos
