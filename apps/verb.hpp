// The verbs of the program. Each adds itself to the command line; what it ends with is the program's exit code.
#pragma once

#include <string>

namespace CLI {
class App;
}

namespace helicoid {

/// Exit codes (contract: *Conduct of the program*).
inline constexpr int kDone = 0;
inline constexpr int kCouldNot = 1;
inline constexpr int kUsage = 2;
inline constexpr int kNotAsAsked = 3;

void add_map_verb(CLI::App& program, int& exit_code);
void add_eval_verb(CLI::App& program, int& exit_code);
void add_simulate_verb(CLI::App& program, int& exit_code);
void add_explore_verb(CLI::App& program, int& exit_code);
void add_fit_verb(CLI::App& program, int& exit_code);
void add_info_verb(CLI::App& program, int& exit_code);
void add_plot_verb(CLI::App& program, int& exit_code);
void add_ledger_verb(CLI::App& program, int& exit_code);
void add_explain_verb(CLI::App& program, int& exit_code);
void add_corrupt_verb(CLI::App& program, int& exit_code);
void add_bench_verb(CLI::App& program, int& exit_code);
void add_experiment_verb(CLI::App& program, int& exit_code);

/// Says on stderr why something could not be done; returns kCouldNot.
int report_failure(const std::string& message);
void report_warning(const std::string& message);

}  // namespace helicoid
