#ifndef AIRDOS_PROCESSES_TOOLS_EVALUATE_EVALUATE_COMMAND_H_
#define AIRDOS_PROCESSES_TOOLS_EVALUATE_EVALUATE_COMMAND_H_

#include "common/evaluation/trajectory.h"
#include "processes/node/live/program_cli.h"

namespace airdos {

// The subcommands of airdos-evaluate. Each adds itself with its options and runs if it was given;
// all throw InputError for input that cannot be used.

void AddTrajectoryCommand(CommandLine* app);
void AddPeopleCommand(CommandLine* app);
void AddDetectionsCommand(CommandLine* app);
void AddCurveCommand(CommandLine* app);
void AddSpeedCommand(CommandLine* app);
void AddAblationCommand(CommandLine* app);

/// Repeats warnings on standard error, since the table may go to a file.
void SayWarnings(const Remarks& remarks);

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_TOOLS_EVALUATE_EVALUATE_COMMAND_H_
