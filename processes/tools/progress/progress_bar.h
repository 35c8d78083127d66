#ifndef AIRDOS_PROCESSES_TOOLS_PROGRESS_PROGRESS_BAR_H_
#define AIRDOS_PROCESSES_TOOLS_PROGRESS_PROGRESS_BAR_H_

namespace airdos {

/// Shows on stderr how far a run has got: a bar on a terminal, otherwise one line per ten per cent.
class ProgressBar {
 public:
  ProgressBar();
  void Show(double fraction_done);
  /// Makes room on a terminal for a line on stderr; Show() then draws the bar below it.
  void MakeRoom();

 private:
  bool is_terminal_;
  int last_percent_ = 0;
  bool is_drawn_ = false;  // the cursor stands behind the bar
};

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_TOOLS_PROGRESS_PROGRESS_BAR_H_
