# A page as a source: cmake -DFROM=page.html -DTO=page_template.cpp -DNAME=page_template -P embed.cmake
file(READ ${FROM} bytes HEX)
string(REGEX REPLACE "(..)" "0x\\1," bytes "${bytes}")
# Lines of 32 bytes: compilers are slow on a single one.
string(REPEAT "....," 32 line)
string(REGEX REPLACE "(${line})" "\\1\n" bytes "${bytes}")
file(WRITE ${TO} "#include \"page/page_template.hpp\"

namespace isoweave::cli {
namespace {

constexpr unsigned char kPage[] = {
${bytes}
};

}  // namespace

std::string_view ${NAME}() { return {reinterpret_cast<const char*>(kPage), sizeof(kPage)}; }

}  // namespace isoweave::cli
")
