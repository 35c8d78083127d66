#include "processes/tools/progress/progress_bar.h"

#include <unistd.h>

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <string>

namespace airdos {

ProgressBar::ProgressBar() : is_terminal_(isatty(STDERR_FILENO) == 1) {}

void ProgressBar::Show(double fraction_done) {
  constexpr int kWidth = 40;
  const int percent = static_cast<int>(100 * std::clamp(fraction_done, 0.0, 1.0));
  if (is_terminal_ && percent != last_percent_) {
    std::string bar(static_cast<std::size_t>(kWidth * percent / 100), '#');
    bar.resize(kWidth, '.');
    std::fprintf(stderr, "\r[%s] %3d %%%s", bar.c_str(), percent, percent == 100 ? "\n" : "");
    last_percent_ = percent;
    is_drawn_ = percent < 100;
  } else if (!is_terminal_ && percent / 10 > last_percent_ / 10) {
    std::fprintf(stderr, "%d %%\n", percent / 10 * 10);
    last_percent_ = percent;
  }
}

void ProgressBar::MakeRoom() {
  if (!is_drawn_) return;
  constexpr char kEraseLine[] = "\r\033[K";
  std::fputs(kEraseLine, stderr);
  last_percent_ = -1;
  is_drawn_ = false;
}

}  // namespace airdos
