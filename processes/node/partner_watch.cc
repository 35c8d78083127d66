#include "processes/node/partner_watch.h"

#include <cmath>
#include <sstream>

#include "common/util/quantile.h"

namespace airdos {
namespace {

constexpr double kMaxShareWithout = 0.2;  // a camera that loses more deserves a warning
constexpr double kMaxStep = 0.5;          // relative to the time between two images
constexpr double kMinOffset_us = 2000;

}  // namespace

std::string PartnerWatch::Add(const Header& left, const std::optional<Header>& partner,
                              const StrayWatch& left_numbers, const StrayWatch& numbers) {
  ++num_left_;
  num_with_partner_ += partner ? 1 : 0;
  // In double, since differences of hostile times overflow.
  const auto between_us = [](std::int64_t from, std::int64_t to) {
    return std::abs(static_cast<double>(to) - static_cast<double>(from));
  };
  if (last_utime_) steps_us_.push_back(between_us(*last_utime_, left.utime));
  if (partner) offsets_us_.push_back(between_us(left.utime, partner->utime));
  last_utime_ = left.utime;
  if (!schedule_.IsDue()) return "";
  std::string text = are_times_said_ ? "" : JudgeTimes();
  if (text.empty() && !are_numbers_said_) {
    text = JudgeNumbers(left.session, left_numbers, numbers);
  }
  num_left_ = num_with_partner_ = 0;
  steps_us_.clear();
  offsets_us_.clear();
  return text;
}

std::string PartnerWatch::JudgeNumbers(std::int64_t session, const StrayWatch& left_numbers,
                                       const StrayWatch& numbers) {
  const int num_without = num_left_ - num_with_partner_;
  if (num_without < kMaxShareWithout * num_left_) return "";
  if (may_be_silent_ && !numbers.newest()) return "";  // LcmRunner reports silent channels
  are_numbers_said_ = true;
  std::ostringstream text;
  text << "no " << what_ << " came for " << num_without << " of " << num_left_
       << " left images: " << channel_;
  if (!numbers.newest() || !left_numbers.newest()) {
    text << " is silent; is it published, and under this name?";
  } else if (numbers.newest()->session != session) {
    text << " has session " << numbers.newest()->session << ", the left images have session "
         << session << "; both must have the same session";
  } else if (num_with_partner_ == 0) {
    text << " counts from " << numbers.first_of_session()->seq << ", the left images from "
         << left_numbers.first_of_session()->seq << "; do both drivers count from the same number?";
  } else {
    text << " skips images, or loses them in transit; airdos-doctor checks the network";
  }
  return text.str();
}

std::string PartnerWatch::JudgeTimes() {
  const double offset_us = Quantile(offsets_us_, 0.5);
  if (offset_us < kMinOffset_us || offset_us < kMaxStep * Quantile(steps_us_, 0.5)) return "";
  are_times_said_ = true;
  std::ostringstream text;
  text << channel_ << " is " << 1e-6 * offset_us << " s away from the left image of the same "
       << "number (median): do both drivers count from the same image and use the same clock?";
  return text.str();
}

}  // namespace airdos
