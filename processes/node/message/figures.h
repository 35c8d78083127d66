#ifndef AIRDOS_PROCESSES_NODE_MESSAGE_FIGURES_H_
#define AIRDOS_PROCESSES_NODE_MESSAGE_FIGURES_H_

namespace airdos::figure {

// Entries of process_status_t's channels that are no channel but a figure, in lower case, whose
// value is num_received: a member of its own would make all recorded STATUS messages undecodable.

/// Of the frontend: how far the rows of matches in left and right images lie apart, 0.001 px
/// (median; RowWatch::error_px()). There from about the fifth pair on; above 1500 the images are
/// not rectified.
inline constexpr char kRowError_millipx[] = "row_error_millipx";

}  // namespace airdos::figure

#endif  // AIRDOS_PROCESSES_NODE_MESSAGE_FIGURES_H_
