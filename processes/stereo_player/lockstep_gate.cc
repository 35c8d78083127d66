#include "processes/stereo_player/lockstep_gate.h"

#include <algorithm>
#include <sstream>
#include <utility>

namespace airdos {
namespace {

std::string Seconds(double value_s) {
  std::ostringstream text;
  text.precision(3);
  text << value_s << " s";
  return text.str();
}

}  // namespace

LockstepGate::LockstepGate(const LockstepGateOptions& options, double now_s)
    : options_(options), start_s_(now_s) {
  for (const std::string& name : options_.wait_for) {
    processes_[name].heard_s = now_s;
    processes_[name].reminded_s = now_s;
  }
}

void LockstepGate::NoteNewcomer(const process_status_t& status) {
  constexpr std::size_t kMostProcesses = 64;  // anybody may publish anything
  if (pids_.size() >= kMostProcesses && pids_.count(status.process) == 0) return;
  std::int64_t& pid = pids_[status.process];
  has_newcomer_ = has_newcomer_ || (pid != status.pid && !published_.empty());
  pid = status.pid;
}

void LockstepGate::OnStatus(const process_status_t& status, double now_s) {
  const bool is_there = status.state == process_status_t::STATE_READY ||
                        status.state == process_status_t::STATE_STALLED;
  if (is_there) NoteNewcomer(status);
  const auto it = processes_.find(status.process);
  if (it == processes_.end()) return;
  Process& process = it->second;
  const bool is_leaving = status.state == process_status_t::STATE_STOPPING;
  if (is_leaving) {
    if (process.state == State::kPresent && process.pid == status.pid) {
      GiveUp(status.process, "has stopped", &process, now_s);
    }
    return;
  }
  if (!is_there) return;
  process.heard_s = now_s;
  process.is_idle = status.state == process_status_t::STATE_READY && status.waiting_for.empty();
  if (process.state == State::kPresent && process.pid == status.pid) return;
  if (process.state == State::kPresent) {
    Note(status.process + " was restarted (process " + std::to_string(process.pid) + ", now " +
         std::to_string(status.pid) + "): continuing, it missed " +
         std::to_string(process.num_in_flight) + " frames at least");
  } else if (process.state == State::kGivenUp) {
    Note(status.process + " is there (process " + std::to_string(status.pid) + ")");
  }
  process.state = State::kPresent;
  process.pid = status.pid;
  process.num_in_flight = 0;
  process.progress_s = now_s;
  process.reminded_s = now_s;
}

void LockstepGate::OnFrameDone(const frame_done_t& done, double now_s) {
  const auto it = processes_.find(done.process);
  if (it == processes_.end()) return;
  Process& process = it->second;
  process.heard_s = now_s;
  // The process works in order, so earlier frames are done as well: either they, or their
  // FRAME_DONE, were lost.
  for (std::size_t newer = 0; newer < process.num_in_flight; ++newer) {
    const Published& frame = published_[published_.size() - 1 - newer];
    if (frame.session != done.session || frame.seq != done.seq) continue;
    process.num_in_flight = newer;
    process.progress_s = now_s;
    process.reminded_s = now_s;
    return;
  }
}

void LockstepGate::OnPublished(std::int64_t session, std::int64_t seq, double now_s) {
  published_.push_back({session, seq});
  for (auto& [name, process] : processes_) {
    if (process.state != State::kPresent) continue;
    if (process.num_in_flight == 0) {
      process.progress_s = now_s;
      process.reminded_s = now_s;
    }
    if (process.num_in_flight < kMaxInFlight) ++process.num_in_flight;
  }
  std::size_t most_in_flight = 1;
  for (const auto& [name, process] : processes_) {
    most_in_flight = std::max(most_in_flight, process.num_in_flight);
  }
  while (published_.size() > most_in_flight) published_.pop_front();
}

bool LockstepGate::MayPublish(double now_s) {
  CheckWaits(now_s);
  const auto limit = static_cast<std::size_t>(std::max(1, options_.frames_in_flight));
  return std::none_of(processes_.begin(), processes_.end(), [&](const auto& entry) {
    const Process& process = entry.second;
    return process.state == State::kAbsent ||
           (process.state == State::kPresent && process.num_in_flight >= limit);
  });
}

bool LockstepGate::IsAllDone(double now_s) {
  CheckWaits(now_s);
  return std::none_of(processes_.begin(), processes_.end(), [](const auto& entry) {
    return entry.second.state == State::kPresent && entry.second.num_in_flight > 0;
  });
}

void LockstepGate::CheckWaits(double now_s) {
  for (auto& [name, process] : processes_) CheckWait(name, &process, now_s);
}

void LockstepGate::CheckWait(const std::string& name, Process* process, double now_s) {
  if (process->state == State::kGivenUp) return;
  if (process->state == State::kAbsent) {
    if (now_s - start_s_ > options_.start_s) {
      GiveUp(name, "has not reported READY for " + Seconds(options_.start_s), process, now_s);
      return;
    }
  } else if (now_s - process->heard_s > options_.silence_s) {
    GiveUp(name, "is silent for " + Seconds(options_.silence_s), process, now_s);
    return;
  } else if (process->num_in_flight > 0 && now_s - process->progress_s > options_.no_progress_s) {
    GiveUp(name, "has finished no frame for " + Seconds(options_.no_progress_s), process, now_s);
    return;
  } else if (process->num_in_flight == 0) {
    return;
  } else if (process->is_idle && now_s - process->progress_s > options_.idle_s) {
    Note(name + " has had no frame to process for " + Seconds(options_.idle_s) + ": the " +
         std::to_string(process->num_in_flight) + " in transit to it are lost, continuing");
    process->num_in_flight = 0;
    return;
  }
  if (now_s - process->reminded_s < options_.remind_s) return;
  process->reminded_s = now_s;
  Note("waiting for " + name +
       (process->state == State::kAbsent
            ? " to report READY"
            : " to finish a frame, " + std::to_string(process->num_in_flight) + " in flight"));
}

void LockstepGate::GiveUp(const std::string& name, const std::string& why, Process* process,
                          double now_s) {
  Note(name + " " + why + ": continuing without it");
  process->state = State::kGivenUp;
  process->num_in_flight = 0;
  process->reminded_s = now_s;
}

void LockstepGate::Note(const std::string& line) {
  if (num_notes_ >= kMaxNotes) return;
  ++num_notes_;
  notes_.push_back(num_notes_ < kMaxNotes ? line : line + " (no more messages will follow)");
}

std::vector<std::string> LockstepGate::TakeNotes() { return std::exchange(notes_, {}); }

bool LockstepGate::TakeNewcomer() { return std::exchange(has_newcomer_, false); }

}  // namespace airdos
