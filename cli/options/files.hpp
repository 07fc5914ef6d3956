// The files that the options of all verbs name.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>

#include "options/cli_app.hpp"

namespace isoweave::cli {

// The file that a user names: "-" is standard input.
std::string input_file(const std::string& path);

// Whether the volume comes out of standard input or another pipe, so that a later process cannot read it again.
bool is_read_once(const std::string& path);

// Refuses outputs that would write over an input, and two outputs to one file.
void check_different(std::initializer_list<std::string_view> paths);

// The name for an output that is not given: that of the input, with `more` behind it and another ending, beside it.
// scan.nii.gz becomes scan.ply, and https://host/scan.zarr scan.ply in the folder where the program runs. Throws
// CLI::RequiredError for an input without such a name, and CannotWrite where the file exists: only a name that was
// typed replaces a file.
std::string usual_output(const std::string& input, std::string_view more, std::string_view ending);

// Adds --no-clobber.
void add_clobber_option(CLI::App& verb, bool& no_clobber);

// Throws CannotWrite where an output exists that --no-clobber protects. Empty paths are no outputs.
void check_absent(bool no_clobber, std::initializer_list<std::string_view> outputs);

}  // namespace isoweave::cli
