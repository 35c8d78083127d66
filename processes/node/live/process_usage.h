#ifndef AIRDOS_PROCESSES_NODE_LIVE_PROCESS_USAGE_H_
#define AIRDOS_PROCESSES_NODE_LIVE_PROCESS_USAGE_H_

#include <cstddef>
#include <cstdint>
#include <vector>

namespace airdos {

/// Wall clock, us. For latencies and heartbeats only: the time of data is its capture time.
std::int64_t WallClock_us();
/// A monotonic clock, s.
double SteadyClock_s();
/// CPU time used by this process so far, ms.
double CpuTime_ms();
/// Resident memory of this process, MB.
double ResidentMemory_mb();

/// Percentiles of the most recent values.
class RecentValues {
 public:
  explicit RecentValues(std::size_t capacity) : capacity_(capacity) {}
  void Add(double value);
  /// Their Quantile(); `fraction` is 0..1; 0 if there are no values yet.
  double Percentile(double fraction) const;

 private:
  std::size_t capacity_;
  std::size_t next_ = 0;
  std::vector<double> values_;
};

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_NODE_LIVE_PROCESS_USAGE_H_
