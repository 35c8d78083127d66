// Prints who is near the camera: a line for each image, from what the optimizer publishes.
//
// Usage: who_is_near [METRES]     (default 5; the LCM URL is LCM_DEFAULT_URL, or LCM's default)

#include <airdos/channels.h>
#include <airdos/codec.h>

#include <airdos/map_update_t.hpp>
#include <airdos/state_estimate_t.hpp>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <lcm/lcm-cpp.hpp>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace {

// What is known of one image. Pose and people come on two channels, in any order, and many people
// come in several parts.
struct Frame {
  std::optional<airdos::state_estimate_t> pose;
  std::vector<airdos::human_state_t> people;
  int num_parts_heard = 0;
  int num_parts = 1;
};

class WhoIsNear {
 public:
  explicit WhoIsNear(double near_m) : near_m_(near_m) {}

  void OnPose(const lcm::ReceiveBuffer* buffer, const std::string&) {
    airdos::state_estimate_t pose;
    if (!airdos::Decode(buffer->data, buffer->data_size, &pose)) return;
    const Key key = {pose.session, pose.seq};
    frames_[key].pose = pose;
    PrintIfComplete(key);
  }

  void OnMap(const lcm::ReceiveBuffer* buffer, const std::string&) {
    airdos::map_update_t map;
    if (!airdos::Decode(buffer->data, buffer->data_size, &map)) return;
    const Key key = {map.session, map.seq};
    Frame& frame = frames_[key];
    frame.num_parts = map.num_parts;
    ++frame.num_parts_heard;
    for (const airdos::human_state_t& person : map.humans) {
      // People of the frame that leaves the window are told once more, refined; only the newest
      // matter here.
      if (person.seq == map.seq && person.num_joints > 0) frame.people.push_back(person);
    }
    PrintIfComplete(key);
  }

 private:
  // A new session is a new world, and its images are counted anew.
  using Key = std::pair<std::int64_t, std::int64_t>;
  static constexpr std::size_t kMaxFrames =
      100;  // of which something is still missing: it may be lost

  void PrintIfComplete(const Key& key) {
    const Frame& frame = frames_.at(key);
    if (frame.pose && frame.num_parts_heard >= frame.num_parts) {
      Print(key, frame);
      frames_.erase(key);
    }
    if (frames_.size() > kMaxFrames) frames_.erase(frames_.begin());
  }

  void Print(const Key& key, const Frame& frame) const {
    std::printf("session %lld image %lld: ", static_cast<long long>(key.first),
                static_cast<long long>(key.second));
    if (frame.pose->status == airdos::state_estimate_t::STATUS_INVALID) {
      std::printf("no pose\n");
      return;
    }
    const double* camera = frame.pose->position_W_C;
    std::vector<std::pair<double, std::int64_t>> near;  // distance, number of the person
    for (const airdos::human_state_t& person : frame.people) {
      const double distance_m = Distance(person, camera);
      if (distance_m <= near_m_) near.emplace_back(distance_m, person.track_id);
    }
    std::sort(near.begin(), near.end());
    std::printf("camera at %.3f %.3f %.3f, %zu people", camera[0], camera[1], camera[2],
                frame.people.size());
    for (const auto& [distance_m, id] : near) {
      std::printf(", person %lld at %.2f m", static_cast<long long>(id), distance_m);
    }
    std::printf("\n");
    std::fflush(stdout);
  }

  // From the camera to the middle of the person's joints, both in the world W, in m.
  static double Distance(const airdos::human_state_t& person, const double camera[3]) {
    double sum[3] = {};
    for (int i = 0; i < person.num_joints; ++i) {
      sum[0] += person.x_W_m[i];
      sum[1] += person.y_W_m[i];
      sum[2] += person.z_W_m[i];
    }
    double squared = 0;
    for (int axis = 0; axis < 3; ++axis)
      squared += std::pow(sum[axis] / person.num_joints - camera[axis], 2);
    return std::sqrt(squared);
  }

  double near_m_;
  std::map<Key, Frame> frames_;
};

}  // namespace

int main(int argc, char** argv) {
  const double near_m = argc > 1 ? std::atof(argv[1]) : 5;
  if (argc > 2 || !(near_m > 0)) {
    std::fprintf(stderr, "Usage: %s [METRES]\n", argv[0]);
    return 2;
  }
  lcm::LCM lcm;
  if (!lcm.good()) return 1;  // LCM has said why
  WhoIsNear who_is_near(near_m);
  // LCM keeps 30 messages for us and then loses the newest; 0 is without a limit.
  lcm.subscribe(airdos::channel::kStateEstimate, &WhoIsNear::OnPose, &who_is_near)
      ->setQueueCapacity(0);
  lcm.subscribe(airdos::channel::kMapUpdate, &WhoIsNear::OnMap, &who_is_near)->setQueueCapacity(0);
  std::printf("listening\n");
  std::fflush(stdout);
  while (lcm.handle() == 0) {
  }
  return 1;
}
