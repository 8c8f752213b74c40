// One file per subcommand. Each add_… adds its subcommand, its options and the function to run, which returns
// the exit status: 0 done, 1 the run found a failure that it looks for. Faults of the user or the machine are
// thrown (base/error.h).
#pragma once

#include "command_line/command_line.h"

namespace lightgrid::app {

void add_render(CommandLine& line);
void add_compare(CommandLine& line);
void add_plan(CommandLine& line);
void add_scenes(CommandLine& line);
void add_info(CommandLine& line);
void add_techniques(CommandLine& line);
void add_capture(CommandLine& line);
void add_cull(CommandLine& line);
void add_inspect(CommandLine& line);
void add_reference(CommandLine& line);
void add_devices(CommandLine& line);
void add_verify(CommandLine& line);
void add_bench(CommandLine& line);
void add_frontier(CommandLine& line);
void add_which(CommandLine& line);
void add_golden(CommandLine& line);
void add_check(CommandLine& line);
void add_view(CommandLine& line);
void add_manual(CommandLine& line);

}  // namespace lightgrid::app
