#include "processes/node/bus/parallel_bus.h"

#include <algorithm>
#include <functional>
#include <iterator>
#include <sstream>
#include <utility>

#include "common/util/check.h"
#include "processes/node/log/log_source.h"

namespace airdos {
namespace {

bool Contains(const std::vector<std::string>& list, const std::string& text) {
  return std::find(list.begin(), list.end(), text) != list.end();
}

std::int64_t SessionOf(const Envelope& message) {
  return PeekHeader(message.payload.data(), message.payload.size()).value_or(Header{}).session;
}

}  // namespace

ParallelBus::~ParallelBus() {
  {
    const Lock lock(mutex_);
    must_stop_ = true;
    changed_.notify_all();
  }
  for (const auto& worker : workers_) {
    if (worker->thread.joinable()) worker->thread.join();
  }
}

// Whether what the first node publishes can cause the second one to publish.
std::vector<std::vector<bool>> ParallelBus::Reachable(bool without_feedback) const {
  const std::size_t size = members().size();
  std::vector<std::vector<bool>> reaches(size, std::vector<bool>(size, false));
  for (std::size_t from = 0; from < size; ++from) {
    for (std::size_t to = 0; to < size; ++to) {
      for (const std::string& channel : members()[from].outputs) {
        const bool is_cut = without_feedback && workers_[to]->feedback.count(channel) > 0;
        if (!is_cut && Contains(members()[to].inputs, channel)) reaches[from][to] = true;
      }
    }
  }
  for (std::size_t middle = 0; middle < size; ++middle) {
    for (std::size_t from = 0; from < size; ++from) {
      for (std::size_t to = 0; to < size; ++to) {
        if (reaches[from][middle] && reaches[middle][to]) reaches[from][to] = true;
      }
    }
  }
  return reaches;
}

// Of the channels in a cycle, those that make up frames count as forward: the inputs of a frame
// cannot wait for the frame itself.
void ParallelBus::FindFeedback() {
  const auto reaches = Reachable(false);
  for (std::size_t to = 0; to < members().size(); ++to) {
    const Member& member = members()[to];
    for (std::size_t from = 0; from < members().size(); ++from) {
      bool comes_forward = false;
      for (const std::string& channel : members()[from].outputs) {
        if (!Contains(member.inputs, channel)) continue;
        const bool is_feedback = reaches[to][from] && !member.node->MakesUpFrames(channel);
        if (is_feedback) workers_[to]->feedback.insert(channel);
        if (!is_feedback) comes_forward = true;
      }
      if (comes_forward) workers_[to]->predecessors.push_back(from);
    }
  }
}

bool ParallelBus::HasCircle() const {
  const auto reaches = Reachable(true);
  for (std::size_t i = 0; i < reaches.size(); ++i) {
    if (reaches[i][i]) return true;
  }
  return false;
}

void ParallelBus::Start() {
  if (has_started_) return;
  has_started_ = true;
  for (std::size_t i = 0; i < members().size(); ++i) workers_.push_back(std::make_unique<Worker>());
  FindFeedback();
  has_threads_ = !HasCircle();
  is_serial_ = !has_threads_;
  if (!has_threads_) {  // a single thread never waits for another node
    for (const auto& worker : workers_) worker->predecessors.clear();
    return;
  }
  for (std::size_t i = 0; i < workers_.size(); ++i)
    workers_[i]->thread = std::thread([this, i] { RunWorker(i); });
}

// Lower bound for the place of anything that the node may still take in and publish after.
SerialPlace ParallelBus::Bound(std::size_t worker) const {
  const Worker& self = *workers_[worker];
  if (self.is_busy || !self.awaited.empty()) return self.now;
  SerialPlace bound{num_inputs_, {}};
  if (!self.forward.empty()) bound = std::min(bound, self.forward.front().place);
  for (const std::size_t predecessor : self.predecessors)
    bound = std::min(bound, NextOutput(predecessor));
  return std::max(bound, self.now);
}

// Lower bound for the place of what the node publishes next.
SerialPlace ParallelBus::NextOutput(std::size_t worker) const {
  const SerialPlace bound = Bound(worker);
  const Worker& self = *workers_[worker];
  return bound.Then({worker, bound == self.now ? self.num_published : 0});
}

bool ParallelBus::MayTake(std::size_t worker, const Letter& letter) const {
  const auto& predecessors = workers_[worker]->predecessors;
  return std::all_of(predecessors.begin(), predecessors.end(), [&](std::size_t predecessor) {
    return letter.place < NextOutput(predecessor);
  });
}

std::optional<ParallelBus::Letter> ParallelBus::Take(std::size_t worker, bool only_look) {
  Worker& self = *workers_[worker];
  std::deque<Letter>& queue = self.awaited.empty() ? self.forward : self.returned;
  auto it = queue.begin();
  if (self.awaited.empty()) {
    if (it == queue.end() || !MayTake(worker, *it)) return std::nullopt;
  } else {
    it = std::find_if(queue.begin(), queue.end(), [&](const Letter& letter) {
      return self.awaited.count(letter.message->channel) > 0;
    });
    if (it == queue.end()) return std::nullopt;
  }
  Letter letter = *it;
  if (!only_look) queue.erase(it);
  return letter;
}

void ParallelBus::Post(const SerialPlace& place, Envelope message) {
  const Letter letter{place, std::make_shared<const Envelope>(std::move(message))};
  const std::string& channel = letter.message->channel;
  unseen_.emplace(place, letter.message);
  std::size_t num_held = unseen_.size();
  for (std::size_t i = 0; i < workers_.size(); ++i) {
    Worker& worker = *workers_[i];
    if (Contains(members()[i].inputs, channel)) {
      if (worker.feedback.count(channel) > 0) {
        worker.returned.push_back(letter);
      } else {
        const auto is_before = [](const Letter& a, const Letter& b) { return a.place < b.place; };
        const auto end = worker.forward.end();
        worker.forward.insert(std::upper_bound(worker.forward.begin(), end, letter, is_before),
                              letter);
      }
    }
    num_held += worker.forward.size() + worker.returned.size();
  }
  max_held_ = std::max(max_held_, num_held);
}

void ParallelBus::PostInput(Envelope message) {
  const SerialPlace place{num_inputs_++, {}};
  Post(place, std::move(message));
}

bool ParallelBus::IsQuiet() {
  for (std::size_t i = 0; i < workers_.size(); ++i) {
    if (workers_[i]->is_busy || Take(i, /*only_look=*/true)) return false;
  }
  return true;
}

bool ParallelBus::HasRoom() {
  std::int64_t oldest = num_inputs_;
  std::size_t num_pending = 0;
  for (std::size_t i = 0; i < workers_.size(); ++i) {
    oldest = std::min(oldest, Bound(i).input);
    num_pending = std::max(num_pending, workers_[i]->num_pending);
  }
  while (!frame_ends_.empty() && frame_ends_.front() < oldest) frame_ends_.pop_front();
  return frame_ends_.size() < kFramesInFlight && num_pending <= kMaxPending;
}

bool ParallelBus::HasPending() const {
  return std::any_of(workers_.begin(), workers_.end(),
                     [](const auto& worker) { return worker->num_pending > 0; });
}

void ParallelBus::WorkAndPost(std::size_t worker, const std::function<void()>& work, Lock* lock) {
  Member& member = members()[worker];
  const std::size_t num_declared = member.outputs.size();
  lock->unlock();
  std::vector<Envelope> output = Work(&member, work);
  lock->lock();
  AIRDOS_CHECK(member.outputs.size() == num_declared);  // otherwise nobody knew to wait for it
  Worker& self = *workers_[worker];
  for (Envelope& message : output)
    Post(self.now.Then({worker, self.num_published++}), std::move(message));
  if (!output.empty()) changed_.notify_all();
}

void ParallelBus::Deliver(std::size_t worker, const Letter& letter, Lock* lock) {
  Worker& self = *workers_[worker];
  Node* node = members()[worker].node;
  self.is_busy = true;
  if (self.now < letter.place) {
    self.now = letter.place;
    self.num_published = 0;
  }
  const Envelope& message = *letter.message;
  const auto receive = [&] {
    node->Receive(message.channel, message.payload.data(), message.payload.size());
  };
  WorkAndPost(worker, receive, lock);
  for (bool has_worked = true; has_worked;)
    WorkAndPost(
        worker, [&] { has_worked = node->Step(); }, lock);

  std::istringstream lacking(node->waiting_for());
  self.awaited = {std::istream_iterator<std::string>(lacking), {}};
  if (!std::includes(self.feedback.begin(), self.feedback.end(), self.awaited.begin(),
                     self.awaited.end())) {
    self.awaited.clear();  // a forward input is missing as well
  }
  self.num_pending = node->num_pending();
  self.is_busy = false;
  changed_.notify_all();
}

void ParallelBus::RunWorker(std::size_t worker) {
  Lock lock(mutex_);
  try {
    for (;;) {
      std::optional<Letter> letter;
      changed_.wait(lock, [&] {
        if (must_stop_ || failure_) return true;
        if (!is_calling_thread_at_work_) letter = Take(worker);
        return letter.has_value();
      });
      if (!letter) return;
      Deliver(worker, *letter, &lock);
    }
  } catch (...) {
    if (!lock.owns_lock()) lock.lock();
    if (!failure_) failure_ = std::current_exception();
    changed_.notify_all();
  }
}

void ParallelBus::ShowFinished(Lock* lock) {
  for (;;) {
    SerialPlace next{num_inputs_, {}};
    for (std::size_t i = 0; i < workers_.size(); ++i) next = std::min(next, NextOutput(i));
    std::vector<std::shared_ptr<const Envelope>> messages;
    while (!unseen_.empty() && unseen_.begin()->first < next) {
      messages.push_back(std::move(unseen_.begin()->second));
      unseen_.erase(unseen_.begin());
    }
    if (messages.empty()) return;
    lock->unlock();
    for (const auto& message : messages) Observe(*message);
    lock->lock();
  }
}

void ParallelBus::WaitUntil(const std::function<bool()>& condition, Lock* lock) {
  for (;;) {
    ShowFinished(lock);
    if (failure_) std::rethrow_exception(failure_);
    if (condition()) return;
    changed_.wait(*lock);
  }
}

// Delivers each remaining message to each of its nodes, in FifoBus's order.
void ParallelBus::DeliverRest(Lock* lock) {
  is_calling_thread_at_work_ = true;
  for (;;) {
    std::deque<Letter>* queue = nullptr;
    std::deque<Letter>::iterator first;
    std::size_t worker = 0;
    for (std::size_t i = 0; i < workers_.size(); ++i) {
      for (std::deque<Letter>* other : {&workers_[i]->forward, &workers_[i]->returned}) {
        for (auto it = other->begin(); it != other->end(); ++it) {
          if (queue != nullptr && !(it->place < first->place)) continue;
          queue = other;
          first = it;
          worker = i;
        }
      }
    }
    if (queue == nullptr) break;
    const Letter letter = *first;
    queue->erase(first);
    Deliver(worker, letter, lock);
  }
  for (const auto& worker : workers_) {  // nothing can follow the earlier messages any more
    worker->now = {num_inputs_, {}};
    worker->num_published = 0;
  }
  is_calling_thread_at_work_ = false;
  ShowFinished(lock);
}

void ParallelBus::SettleAll(Lock* lock) {
  WaitUntil([this] { return IsQuiet(); }, lock);
  DeliverRest(lock);
  frame_ends_.clear();
  is_serial_ = !has_threads_ || HasPending();
}

void ParallelBus::PublishFrame(std::vector<Envelope> frame) {
  if (frame.empty()) return;
  Lock lock(mutex_);
  Start();
  const std::int64_t session = SessionOf(frame.front());
  const bool is_plain = frame.size() <= kMaxFrameMessages &&
                        std::all_of(frame.begin(), frame.end(), [&](const Envelope& message) {
                          return SessionOf(message) == session;
                        });
  if (!is_plain || session_ != session) SettleAll(&lock);
  session_ = session;
  if (!is_serial_ && is_plain) {
    WaitUntil([this] { return HasRoom() || IsQuiet(); }, &lock);
    if (!HasRoom()) {
      ++num_stalls_;
      SettleAll(&lock);
    }
  }
  if (!is_serial_ && is_plain) {
    for (Envelope& message : frame) PostInput(std::move(message));
    frame_ends_.push_back(num_inputs_ - 1);
    changed_.notify_all();
    return;
  }
  ++num_stalls_;
  for (Envelope& message : frame) {
    PostInput(std::move(message));
    DeliverRest(&lock);
  }
  SettleAll(&lock);
}

void ParallelBus::Settle() {
  Lock lock(mutex_);
  SettleAll(&lock);
}

void ParallelBus::Finish() {
  Lock lock(mutex_);
  Start();
  SettleAll(&lock);
  while (Member* member = NextToComplete()) {
    const auto worker = static_cast<std::size_t>(member - members().data());
    is_calling_thread_at_work_ = true;
    workers_[worker]->now = {num_inputs_++, {}};
    bool has_worked = false;
    WorkAndPost(
        worker, [&] { has_worked = member->node->CompleteOldest(); }, &lock);
    AIRDOS_CHECK(has_worked);
    for (bool has_more = true; has_more;)
      WorkAndPost(
          worker, [&] { has_more = member->node->Step(); }, &lock);
    DeliverRest(&lock);
  }
}

}  // namespace airdos
