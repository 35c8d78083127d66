#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "common/util/error.h"
#include "processes/node/message/types_fingerprint.h"
#include "processes/tools/doctor/doctor_bus.h"
#include "processes/tools/doctor/doctor_machine.h"
#include "processes/tools/doctor/doctor_network.h"

namespace airdos {
namespace {

namespace fs = std::filesystem;

/// The worst that is said of this kind; nothing where it is not mentioned.
std::optional<Health> WorstOf(const Diagnoses& diagnoses, const std::string& kind) {
  std::optional<Health> worst;
  for (const Diagnosis& diagnosis : diagnoses) {
    if (diagnosis.kind == kind) worst = std::max(worst.value_or(Health::kOk), diagnosis.health);
  }
  return worst;
}

TEST(MulticastUrlTest, Parses) {
  const MulticastUrl plain = ParseMulticastUrl("udpm://");
  EXPECT_EQ(plain.address, "239.255.76.67");
  EXPECT_EQ(plain.port, 7667);
  EXPECT_EQ(plain.ttl, 0);
  const MulticastUrl full = ParseMulticastUrl("udpm://239.1.2.3:7000?recv_buf_size=5000&ttl=1");
  EXPECT_EQ(full.address, "239.1.2.3");
  EXPECT_EQ(full.port, 7000);
  EXPECT_EQ(full.ttl, 1);
  EXPECT_EQ(full.recv_buf_size, 5000);
  EXPECT_EQ(WithPort(full, 7001), "udpm://239.1.2.3:7001?ttl=1");
  for (const char* url : {"memq://", "udpm://10.0.0.1:7667", "udpm://239.255.76.67:70000",
                          "udpm://239.255.76.67:7667?tll=0", "udpm://239.255.76.67:7667?ttl=x",
                          "udpm://239.255.76.67:7667?ttl=99999999999", "udpm://239.255.76:1", ""}) {
    EXPECT_THROW(ParseMulticastUrl(url), InputError) << url;
  }
}

TEST(JudgeRouteTest, NamesWhatIsMissing) {
  MulticastUrl url;
  MulticastRoute route;
  EXPECT_EQ(WorstOf(JudgeRoute(url, route), "network.route"), Health::kFail);
  route = {true, "lo", true, true, true};
  EXPECT_FALSE(HasFail(JudgeRoute(url, route)));
  EXPECT_EQ(WorstOf(JudgeRoute(url, route), "network.ttl"), Health::kOk);
  route.is_multicast = false;
  const Diagnoses flag = JudgeRoute(url, route);
  EXPECT_EQ(WorstOf(flag, "network.interface"), Health::kFail);
  EXPECT_EQ(flag[1].mend, "sudo ip link set lo multicast on");
  route.is_up = false;
  EXPECT_EQ(JudgeRoute(url, route)[1].mend, "sudo ip link set lo up");
  url.ttl = 1;  // over the loopback it goes nowhere, over a network it goes to anybody
  route = {true, "lo", true, true, true};
  EXPECT_EQ(WorstOf(JudgeRoute(url, route), "network.ttl"), Health::kWarn);
  route = {true, "eth0", true, true, false};
  EXPECT_EQ(WorstOf(JudgeRoute(url, route), "network.ttl"), Health::kWarn);
}

TEST(JudgeBufferTest, ComparesWithTheLargestMessage) {
  const MulticastUrl url;
  const auto health = [&](std::int64_t granted) {
    return WorstOf(JudgeBuffer(url, granted, 212992), "network.buffer");
  };
  EXPECT_EQ(health(4194304), Health::kOk);
  EXPECT_EQ(health(212992), Health::kWarn);
  EXPECT_EQ(health(140000), Health::kWarn);
  EXPECT_EQ(health(131071), Health::kFail);
  EXPECT_EQ(WorstOf(JudgeBuffer(url, 4194304, 212991), "network.default_buffer"), Health::kWarn);
  EXPECT_NE(JudgeBuffer(url, 212992, 212992)[0].mend.find("rmem_max"), std::string::npos);
  MulticastUrl small;
  small.recv_buf_size = 20000;
  EXPECT_NE(JudgeBuffer(small, 20000, 212992)[0].mend.find("recv_buf_size"), std::string::npos);
}

process_status_t StatusOf(const std::string& process, std::int64_t pid) {
  process_status_t status = {};
  status.process = process;
  status.pid = pid;
  status.version = "1.0";
  status.types_fingerprint = "abc";
  status.state = process_status_t::STATE_READY;
  return status;
}

BusTraffic TrafficOf(const std::vector<process_status_t>& statuses) {
  BusTraffic traffic;
  traffic.duration_s = 2;
  traffic.channels["STATUS"] = {4, 300};
  for (const process_status_t& status : statuses) {
    traffic.processes[{status.process, status.pid}] = status;
  }
  return traffic;
}

TEST(JudgeTrafficTest, TellsOneRunFromTwo) {
  const MulticastUrl url;
  const auto judge = [&](const BusTraffic& traffic) {
    return JudgeTraffic(url, traffic, "1.0", "abc");
  };
  EXPECT_EQ(WorstOf(judge(BusTraffic()), "bus.port"), Health::kOk);
  const Diagnoses one = judge(TrafficOf({StatusOf("a", 1), StatusOf("b", 2)}));
  EXPECT_EQ(WorstOf(one, "bus.port"), Health::kWarn);
  EXPECT_NE(one[0].what.find("STATUS 2.0/s"), std::string::npos) << one[0].what;
  EXPECT_NE(one[0].mend.find(":7668"), std::string::npos) << one[0].mend;
  EXPECT_FALSE(HasFail(one));
  const Diagnoses two = judge(TrafficOf({StatusOf("a", 1), StatusOf("a", 3)}));
  EXPECT_EQ(WorstOf(two, "bus.port"), Health::kFail);
  EXPECT_NE(two[0].what.find("a (1) and a (3)"), std::string::npos) << two[0].what;
}

TEST(JudgeTrafficTest, TellsOthersVersionsAndTypes) {
  process_status_t status = StatusOf("a", 1);
  const auto worst = [&](const std::string& kind) {
    return WorstOf(JudgeTraffic({}, TrafficOf({status}), "1.0", "abc"), kind);
  };
  EXPECT_EQ(worst("bus.types"), std::nullopt);
  status.version = "0.9";
  EXPECT_EQ(worst("bus.version"), Health::kWarn);
  status.types_fingerprint = "abd";
  EXPECT_EQ(worst("bus.types"), Health::kFail);
  BusTraffic strange = TrafficOf({});
  strange.num_strange_status = 1;
  EXPECT_EQ(WorstOf(JudgeTraffic({}, strange, "1.0", "abc"), "bus.types"), Health::kFail);
}

TEST(JudgeTrafficTest, PassesOnWhatProcessesComplainOf) {
  process_status_t status = StatusOf("a", 1);
  status.state = process_status_t::STATE_STALLED;
  status.waiting_for = "PERSON_MASK";
  status.last_error = "disk full";
  status.channels.resize(1);
  status.channels[0].channel = "CAMERA_LEFT";
  status.channels[0].num_rejected = 2;
  BusTraffic traffic = TrafficOf({status});
  traffic.channels["CAMERA_LEFT"] = {60, 131073};
  const Diagnoses all = JudgeTraffic({}, traffic, "1.0", "abc");
  for (const char* kind : {"bus.stalled", "bus.error", "bus.rejected", "bus.size"}) {
    EXPECT_EQ(WorstOf(all, kind), Health::kWarn) << kind;
  }
}

TEST(JudgeTrafficTest, ShowsTheRowErrorOfTheFrontend) {
  process_status_t status = StatusOf("airdos-frontend", 1);
  const auto rows = [&](std::int64_t millipx) {
    status.channels.resize(1);
    status.channels[0].channel = "row_error_millipx";
    status.channels[0].num_received = millipx;
    for (const Diagnosis& diagnosis : JudgeTraffic({}, TrafficOf({status}), "1.0", "abc")) {
      if (diagnosis.kind == "bus.rows") return diagnosis;
    }
    return Diagnosis();
  };
  EXPECT_EQ(rows(137).health, Health::kOk);
  EXPECT_EQ(rows(137).what,
            "airdos-frontend (1): rows of left and right images differ by 0.14 px (median)");
  EXPECT_EQ(rows(1500).health, Health::kOk);
  EXPECT_EQ(rows(1501).health, Health::kWarn);
}

TEST(JudgeRoundTripTest, LossAndLatency) {
  const auto health = [](const RoundTrip& trip) { return JudgeRoundTrip(trip)[0].health; };
  EXPECT_EQ(health({60, 60, 0.5, 2}), Health::kOk);
  EXPECT_EQ(health({60, 60, 0.5, 40}), Health::kWarn);
  EXPECT_EQ(health({600, 599, 0.5, 2}), Health::kWarn);
  EXPECT_EQ(health({60, 59, 0.5, 2}), Health::kFail);
  EXPECT_EQ(health({60, 0, 0, 0}), Health::kFail);
}

TEST(JudgeMachineTest, SpyAndDisk) {
  const fs::path folder = fs::temp_directory_path() / ("airdos_doctor_" + std::to_string(getpid()));
  fs::create_directories(folder);
  SpyPlaces places;
  places.lcm_jar = places.chart_jar = (folder / "no.jar").string();
  places.airdos_jar = {(folder / "none.jar").string(), (folder / "airdos.jar").string()};
  std::ofstream(folder / "airdos.jar") << "x";
  const Diagnoses spy = JudgeSpy(places);
  EXPECT_FALSE(HasFail(spy)) << "only lcm-spy needs it";
  EXPECT_EQ(spy[1].health, Health::kWarn);
  EXPECT_EQ(spy[1].mend, "sudo apt-get install liblcm-java");
  EXPECT_EQ(spy[2].health, Health::kWarn);
  EXPECT_EQ(spy[3].health, Health::kOk);
  EXPECT_NE(JudgeDisk((folder / "run" / "to" / "come").string())[0].what.find("MB free"),
            std::string::npos);
  EXPECT_TRUE(HasFail(JudgeDisk((folder / "airdos.jar" / "run").string())));
  EXPECT_TRUE(HasFail(JudgeDisk("/proc/airdos")));
  fs::remove_all(folder);
}

TEST(TypesFingerprintTest, CoversEveryTypeOfAChannel) {
  EXPECT_EQ(TypesFingerprint().size(), 16u);
  EXPECT_EQ(TypesFingerprint().find_first_not_of("0123456789abcdef"), std::string::npos);
  EXPECT_EQ(MessageTypes().size(), 11u);
  EXPECT_EQ(MessageTypes().count("image_t"), 1u);
}

TEST(DiagnosisTest, IsOneLine) {
  std::ostringstream text;
  Print({{Health::kOk, "a", "well", ""}, {Health::kFail, "b", "ill", "pill"}}, &text);
  EXPECT_EQ(text.str(), "OK   a: well\nFAIL b: ill (mend: pill)\n");
}

}  // namespace
}  // namespace airdos
