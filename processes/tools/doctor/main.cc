// airdos-doctor: tests whether this machine can run the processes, and says how to fix what is
// wrong.
#include <iostream>
#include <nlohmann/json.hpp>

#include "common/util/error.h"
#include "common/util/json_file.h"
#include "common/util/output_files.h"
#include "common/util/version.h"
#include "processes/node/live/lcm_transport.h"
#include "processes/node/live/program_cli.h"
#include "processes/node/message/types_fingerprint.h"
#include "processes/tools/doctor/doctor_bus.h"
#include "processes/tools/doctor/doctor_machine.h"

namespace airdos {
namespace {

struct Arguments {
  std::string lcm_url = DefaultLcmUrl();
  std::string run_dir = ".";
  std::string json;
  bool force = false;
  std::string round_trip = "auto";
  double listen_s = 1.3;  // STATUS is published once a second
  double round_trip_s = 2;
};

void Append(Diagnoses more, Diagnoses* all) { all->insert(all->end(), more.begin(), more.end()); }

void ExamineBus(const Arguments& arguments, const MulticastUrl& url, Diagnoses* result) {
  try {
    const BusTraffic traffic = Listen(arguments.lcm_url, arguments.listen_s);
    Append(JudgeTraffic(url, traffic, kVersion, TypesFingerprint()), result);
    if (arguments.round_trip == "never") return;
    if (arguments.round_trip == "auto" && !traffic.channels.empty()) {
      result->push_back({Health::kOk, "bus.round_trip",
                         "not tried: it would load the run on this port like another camera "
                         "(--round-trip always does)",
                         ""});
      return;
    }
    Append(JudgeRoundTrip(MeasureRoundTrip(arguments.lcm_url, arguments.round_trip_s)), result);
  } catch (const InputError& error) {
    result->push_back({Health::kFail, "bus.open", error.what(), "network_setup.sh"});
  }
}

int Run(const Arguments& arguments) {
  InstallStopSignals();
  const OutputFiles outputs({arguments.json}, {{}, arguments.force});
  const MulticastUrl url = ParseMulticastUrl(arguments.lcm_url);
  Diagnoses result = JudgeRoute(url, FindRoute(url));
  // The same size that LcmTransport requests.
  Append(JudgeBuffer(url, GrantedReceiveBuffer(url.recv_buf_size.value_or(4194304)),
                     GrantedReceiveBuffer(0)),
         &result);
  ExamineBus(arguments, url, &result);
  Append(JudgeDisk(arguments.run_dir), &result);
  Append(JudgeSpy(DefaultSpyPlaces()), &result);
  Print(result, &std::cout);
  if (!arguments.json.empty()) WriteJson(ToJson(result), arguments.json);
  return HasFail(result) ? 1 : 0;
}

}  // namespace
}  // namespace airdos

int main(int argc, char** argv) {
  airdos::CommandLine app(
      "Reports what on this machine prevents a run, one line per finding, with the command "
      "that fixes it. Exit code 0: nothing (warnings are allowed); 1: something; 2: wrong "
      "arguments.",
      "airdos-doctor");
  airdos::Arguments arguments;
  app.Add("--lcm-url", &arguments.lcm_url, "LCM URL of the processes").ShowDefault();
  app.AddFolder("--run-dir", &arguments.run_dir, "folder for results").ShowDefault();
  app.Add("--round-trip", &arguments.round_trip,
          "send and receive test messages: auto (not into a run), always, never")
      .OneOf({"auto", "always", "never"})
      .ShowDefault();
  app.Add("--listen-s", &arguments.listen_s, "time to listen to others (s)")
      .Within(0.1, 3600.0)
      .ShowDefault();
  app.Add("--round-trip-s", &arguments.round_trip_s, "time to send (s)")
      .Within(0.1, 3600.0)
      .ShowDefault();
  app.AddFile("--json", &arguments.json, "file to write the findings to");
  app.AddForce(&arguments.force);
  return airdos::RunProgram(argc, argv, &app, [&] { return airdos::Run(arguments); });
}
