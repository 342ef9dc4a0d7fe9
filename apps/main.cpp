#include <CLI/CLI.hpp>
#include <cstdio>

#include "apps/verb.hpp"

int main(int argc, char** argv) {
  CLI::App program(
      "Helicoid maps buildings with any number of robots and 2-D lasers, on a manifold that never\n"
      "contradicts itself.\n");
  program.set_version_flag("--version", HELICOID_VERSION);
  program.require_subcommand(1);
  program.footer(
      "Example: helicoid simulate office --out sim && helicoid map sim/robot1.clf.gz --out site\n"
      "`helicoid VERB --help` explains a verb. Exit codes: 0 done, 1 could not, 2 usage, 3 done but not as asked.");
  int exit_code = helicoid::kDone;
  helicoid::add_map_verb(program, exit_code);
  helicoid::add_eval_verb(program, exit_code);
  helicoid::add_simulate_verb(program, exit_code);
  helicoid::add_explore_verb(program, exit_code);
  helicoid::add_fit_verb(program, exit_code);
  helicoid::add_ledger_verb(program, exit_code);
  helicoid::add_explain_verb(program, exit_code);
  helicoid::add_info_verb(program, exit_code);
  helicoid::add_plot_verb(program, exit_code);
  helicoid::add_corrupt_verb(program, exit_code);
  helicoid::add_bench_verb(program, exit_code);
  helicoid::add_experiment_verb(program, exit_code);
  try {
    program.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    // Help and version are no errors; everything else that the parser refuses is a matter of usage.
    return program.exit(error) == 0 ? helicoid::kDone : helicoid::kUsage;
  }
  // Figures that did not arrive were not given.
  if (std::fflush(stdout) != 0) return helicoid::report_failure("stdout: cannot be written; is the disc full?");
  return exit_code;
}
