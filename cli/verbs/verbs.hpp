// One function per verb: it describes the verb's options and its action.
#pragma once

#include "options/cli_app.hpp"

namespace isoweave::cli {

void add_mesh_verb(CLI::App& app);
void add_simplify_verb(CLI::App& app);
void add_info_verb(CLI::App& app);
void add_index_verb(CLI::App& app);
void add_check_verb(CLI::App& app);
void add_compare_verb(CLI::App& app);
void add_render_verb(CLI::App& app);
void add_view_verb(CLI::App& app);
void add_generate_verb(CLI::App& app);
void add_plan_verb(CLI::App& app);
void add_work_verb(CLI::App& app);
void add_status_verb(CLI::App& app);
void add_collect_verb(CLI::App& app);

}  // namespace isoweave::cli
