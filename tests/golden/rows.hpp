// The rows of digests.txt.
#pragma once

#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace isoweave::golden {

struct Row {
  std::string name;
  std::vector<std::string> words;    // of the command line, from the verb on
  std::vector<std::string> digests;  // one for each level, the finest first
};

inline std::vector<std::string> words_of(const std::string& text) {
  std::istringstream in(text);
  std::vector<std::string> words;
  for (std::string word; in >> word;) words.push_back(word);
  return words;
}

inline bool is_comment(const std::string& line) { return line.empty() || line[0] == '#'; }

inline Row row_of(const std::string& line) {
  const std::size_t bar = line.find(" | ");
  const std::size_t arrow = line.find(" -> ");
  if (bar == std::string::npos || arrow == std::string::npos) {
    throw std::runtime_error("expected 'NAME | ARGUMENTS -> DIGESTS', found '" + line + "'");
  }
  return {line.substr(0, bar), words_of(line.substr(bar + 3, arrow - bar - 3)), words_of(line.substr(arrow + 4))};
}

inline std::vector<Row> read_rows(const std::string& path) {
  std::ifstream in(path);
  std::vector<Row> rows;
  for (std::string line; std::getline(in, line);) {
    if (!is_comment(line)) rows.push_back(row_of(line));
  }
  return rows;
}

// Puts the digests of these rows in the place of those that the file has.
inline void renew_rows(const std::string& path, const std::vector<Row>& rows) {
  std::ifstream in(path);
  std::ostringstream out;
  std::size_t n = 0;
  for (std::string line; std::getline(in, line);) {
    if (!is_comment(line)) {
      line.resize(line.find(" -> ") + 3);
      for (const std::string& digest : rows.at(n++).digests) line += " " + digest;
    }
    out << line << '\n';
  }
  in.close();
  std::ofstream(path) << out.str();
}

}  // namespace isoweave::golden
