#ifndef AIRDOS_PROCESSES_STEREO_PLAYER_LOCKSTEP_GATE_H_
#define AIRDOS_PROCESSES_STEREO_PLAYER_LOCKSTEP_GATE_H_

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <string>
#include <vector>

#include "airdos/frame_done_t.hpp"
#include "airdos/process_status_t.hpp"

namespace airdos {

/// Which processes the LockstepGate waits for, and for how long.
struct LockstepGateOptions {
  std::vector<std::string> wait_for;  ///< process names as in STATUS; empty to never wait
  int frames_in_flight = 4;
  double remind_s = 5;        ///< interval of reminders about a silent process
  double silence_s = 10;      ///< gives up a process without STATUS and FRAME_DONE
  double no_progress_s = 60;  ///< gives up a process without FRAME_DONE
  /// The same for a process whose STATUS says that it has no frame to process: those in transit to
  /// it are lost.
  double idle_s = 10;
  double start_s = 60;  ///< gives up a process that is absent at the start
};

/// Decides when the player may publish the next frame: once all processes that it waits for have
/// reported READY, and none has more than `frames_in_flight` frames to do. Every wait is bounded,
/// and giving one up is reported. Has no clock: times are passed in, in seconds of one steady
/// clock.
class LockstepGate {
 public:
  /// In realtime pace nothing waits, so the backlog of a process that never publishes FRAME_DONE
  /// keeps growing: frames beyond this limit are not remembered.
  static constexpr std::size_t kMaxInFlight = 1000;
  /// Limit of the lines reported in total: otherwise somebody sending STATUS with ever new pids
  /// would fill the disk that stderr goes to.
  static constexpr int kMaxNotes = 1000;

  LockstepGate(const LockstepGateOptions& options, double now_s);

  void OnStatus(const process_status_t& status, double now_s);
  void OnFrameDone(const frame_done_t& done, double now_s);
  void OnPublished(std::int64_t session, std::int64_t seq, double now_s);

  /// Whether the next frame may be published; gives up waits that took too long.
  bool MayPublish(double now_s);
  /// Whether every process has either done every published frame or been given up.
  bool IsAllDone(double now_s);

  std::size_t num_remembered() const { return published_.size(); }

  /// What the user should know, one line each; each returned once.
  std::vector<std::string> TakeNotes();
  /// A process, whether waited for or not, has started (again) after the first frame and has missed
  /// the calibration. Returns true once per occurrence.
  bool TakeNewcomer();

 private:
  enum class State { kAbsent, kPresent, kGivenUp };
  struct Process {
    State state = State::kAbsent;
    std::int64_t pid = 0;
    double heard_s = 0;     // last STATUS or FRAME_DONE
    double progress_s = 0;  // last FRAME_DONE, or with nothing to do
    double reminded_s = 0;
    bool is_idle = false;           // waiting for frames
    std::size_t num_in_flight = 0;  // they are the last ones of published_
  };
  struct Published {
    std::int64_t session;
    std::int64_t seq;
  };

  void NoteNewcomer(const process_status_t& status);
  void CheckWaits(double now_s);
  void CheckWait(const std::string& name, Process* process, double now_s);
  void GiveUp(const std::string& name, const std::string& why, Process* process, double now_s);
  void Note(const std::string& line);

  LockstepGateOptions options_;
  double start_s_;
  std::map<std::string, Process> processes_;
  std::deque<Published> published_;  // in order; as many as any process has in flight, at least one
  std::map<std::string, std::int64_t> pids_;  // of every process that has reported READY, by name
  std::vector<std::string> notes_;
  int num_notes_ = 0;
  bool has_newcomer_ = false;
};

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_STEREO_PLAYER_LOCKSTEP_GATE_H_
