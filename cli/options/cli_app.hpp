// CLI11's class by its name: its header takes seconds to compile, so only sources that describe options include it.
#pragma once

namespace CLI {  // NOLINT(readability-identifier-naming): theirs
class App;
}
