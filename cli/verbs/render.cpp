// isoweave render: a picture of a mesh as PNG.
#include "isoweave/render.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <charconv>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "isoweave/error.hpp"
#include "options/files.hpp"
#include "options/input_mesh.hpp"
#include "options/values.hpp"
#include "report/print.hpp"
#include "signals.hpp"
#include "verbs/verbs.hpp"

namespace isoweave::cli {
namespace {

constexpr const char* kRenderExamples = R"(
Examples:
  isoweave render bone.ply -o bone.png
  isoweave render bone.ply -o side.png --view right --size 1920x1080 \
    --background transparent
  isoweave render scan.ply -o scan.png --view front --axes --zoom 1.5
  isoweave render small.ply -o mesh.png --wireframe --shading flat --view 150,10
  isoweave render distances.ply -o error.png --color-by quality --range 0,0.5
At --view 0,0 (front) the camera looks along +y with z up, in a mesh that says
RAS along -y: at the face of a patient. Azimuth turns it to the side of +x
(RAS: -x), elevation up. --up y is for files with y up, as most of glTF and OBJ
are: from the front the camera looks along -z then.)";

constexpr std::int64_t kMostPixels = 16384;
constexpr std::int64_t kMostSamples = 8;
constexpr int kWidthsOfBar = 4;  // of a picture that has room for a bar of its colours

struct RenderArguments {
  ReadMeshOptions reading;
  std::string path, output, size = "1200x900", view = "35,20", background = "white", colour = "#decdb4", colour_by,
                            range;
  std::string up = "z", zoom = "1";
  std::string shading = "smooth", samples = "3", threads = "all";
  bool wireframe = false, axes = false, quiet = false, no_clobber = false, no_color_bar = false;
};

int parse_limited(std::string_view option, std::string_view text, std::int64_t most, std::string_view example) {
  const std::int64_t count = parse_count(option, text, example);
  if (count > most) wrong_value(option, fmt::format("at most {}", most), text);
  return static_cast<int>(count);
}

// The two parts around a separator; the second one is empty without it.
std::pair<std::string_view, std::string_view> halves(std::string_view text, char separator) {
  const std::size_t at = std::min(text.find(separator), text.size());
  return {text.substr(0, at), text.substr(std::min(at + 1, text.size()))};
}

View parse_view(std::string_view text) {
  constexpr std::pair<std::string_view, View> kNamed[] = {
      {"front", {0, 0}}, {"right", {90, 0}},   {"back", {180, 0}},   {"left", {-90, 0}},
      {"top", {0, 90}},  {"bottom", {0, -90}}, {"iso", {45, 35.264}}};
  for (const auto& [name, view] : kNamed) {
    if (text == name) return view;
  }
  constexpr std::string_view kExpected =
      "front, back, left, right, top, bottom, iso, or AZIMUTH,ELEVATION in degrees, the second from -90 to 90";
  const auto [azimuth, elevation] = halves(text, ',');
  if (elevation.empty()) wrong_value("--view", kExpected, text);
  const View view{parse_number("--view", azimuth), parse_number("--view", elevation)};
  if (view.elevation < -90 || view.elevation > 90) wrong_value("--view", kExpected, text);
  return view;
}

Axis parse_axis(std::string_view text) {
  return parse_choice<Axis>("--up", text,
                            {{"x", Axis::kX},
                             {"y", Axis::kY},
                             {"z", Axis::kZ},
                             {"-x", Axis::kMinusX},
                             {"-y", Axis::kMinusY},
                             {"-z", Axis::kMinusZ}});
}

double parse_zoom(std::string_view text) {
  const double zoom = parse_number("--zoom", text);
  if (!(zoom >= 0.01 && zoom <= 100)) wrong_value("--zoom", "a number from 0.01 to 100", text);
  return zoom;
}

Colour parse_colour(std::string_view option, std::string_view text) {
  constexpr std::pair<std::string_view, Colour> kNamed[] = {
      {"white", {255, 255, 255}}, {"black", {0, 0, 0}},       {"grey", {128, 128, 128}}, {"gray", {128, 128, 128}},
      {"red", {214, 69, 65}},     {"green", {76, 153, 80}},   {"blue", {66, 133, 199}},  {"yellow", {235, 199, 68}},
      {"orange", {230, 140, 60}}, {"purple", {142, 92, 168}}, {"bone", {222, 205, 180}}};
  for (const auto& [name, colour] : kNamed) {
    if (text == name) return colour;
  }
  unsigned bits = 0;
  const char* const end = text.data() + text.size();
  const bool is_colour =
      text.size() == 7 && text[0] == '#' && std::from_chars(text.data() + 1, end, bits, 16).ptr == end;
  if (!is_colour)
    wrong_value(option, "a colour: #rrggbb, white, black, grey, red, green, blue, yellow, orange, purple or bone",
                text);
  return {static_cast<std::uint8_t>(bits >> 16U), static_cast<std::uint8_t>(bits >> 8U & 255U),
          static_cast<std::uint8_t>(bits & 255U)};
}

std::array<double, 2> parse_range(std::string_view text) {
  const auto [low, high] = halves(text, ',');
  const std::array<double, 2> range{parse_number("--range", low), parse_number("--range", high)};
  if (!(range[0] < range[1])) wrong_value("--range", "LOW,HIGH, the second larger", text);
  return range;
}

RenderOptions parse_options(const RenderArguments& arguments) {
  RenderOptions options;
  auto [width, height] = halves(arguments.size, 'x');
  if (arguments.size.find('x') == std::string::npos) height = width;
  options.width = parse_limited("--size", width, kMostPixels, "1200x900");
  options.height = parse_limited("--size", height, kMostPixels, "1200x900");
  options.view = parse_view(arguments.view);
  options.up = parse_axis(arguments.up);
  options.zoom = parse_zoom(arguments.zoom);
  options.axes = arguments.axes;
  options.background.reset();
  if (arguments.background != "transparent") options.background = parse_colour("--background", arguments.background);
  options.colour = parse_colour("--color", arguments.colour);
  options.shading =
      parse_choice<Shading>("--shading", arguments.shading, {{"smooth", Shading::kSmooth}, {"flat", Shading::kFlat}});
  options.wireframe = arguments.wireframe;
  options.samples = parse_limited("--samples", arguments.samples, kMostSamples, "3");
  options.threads = parse_threads(arguments.threads);
  if (!arguments.colour_by.empty()) parse_choice<int>("--color-by", arguments.colour_by, {{"quality", 0}});
  if (!arguments.range.empty()) {
    if (arguments.colour_by.empty()) throw std::invalid_argument("--range goes with --color-by");
    options.range = parse_range(arguments.range);
  }
  return options;
}

// The numbers at the ends of the colours; none where nothing has a number.
std::optional<std::array<double, 2>> colour_range(const RenderOptions& options, std::span<const float> quality) {
  const std::array<double, 2> range = options.range ? *options.range : finite_range(quality);
  return range[0] <= range[1] ? std::optional(range) : std::nullopt;
}

// The picture, with a bar of its colours where they stand for numbers and the picture has room for one.
Picture draw(const TriangleMesh& mesh, RenderOptions options, const std::optional<std::array<double, 2>>& range) {
  const auto bar = static_cast<int>(colour_bar_width(options.height));
  if (!range || bar > options.width / kWidthsOfBar) return render_mesh(mesh, options, mesh.values);
  options.width -= bar;
  return with_colour_bar(render_mesh(mesh, options, mesh.values), *range, options.background);
}

// Finds an error that would keep the picture from being written, before the picture is made.
void check_output(const std::string& path) {
  if (!path.ends_with(".png") && !path.ends_with(".PNG"))
    throw CannotWrite(path + ": expected a name that ends in .png");
  require_png(path);
}

void run_render(RenderArguments arguments) {
  if (arguments.output.empty()) arguments.output = usual_output(arguments.path, "", ".png");
  const RenderOptions options = parse_options(arguments);
  check_different({arguments.path, arguments.output});
  check_absent(arguments.no_clobber, {arguments.output});
  check_output(arguments.output);
  exit_on_signal();
  TriangleMesh mesh = read_named_mesh(arguments.path, arguments.reading);
  if (mesh.triangles.empty()) throw BadInput(arguments.path + ": expected a mesh with triangles, found none");
  if (!arguments.quiet) print_mesh_warnings(arguments.path, mesh);
  if (arguments.colour_by.empty()) {
    mesh.values.clear();
  } else if (mesh.values.empty()) {
    throw BadInput(arguments.path + ": expected a PLY file with a number such as 'quality' at each vertex, found none");
  }
  const std::optional<std::array<double, 2>> range = colour_range(options, mesh.values);
  write_png(arguments.output, draw(mesh, options, arguments.no_color_bar ? std::nullopt : range));
  if (!arguments.quiet) {
    print_note(fmt::format("{}: {} x {} pixels, {} triangles{}", arguments.output, options.width, options.height,
                           grouped(mesh.triangles.size()),
                           range ? fmt::format(", colours from {:.6g} to {:.6g}", (*range)[0], (*range)[1]) : ""));
  }
}

}  // namespace

void add_render_verb(CLI::App& app) {
  CLI::App* verb = app.add_subcommand("render", "Draw a mesh as a PNG picture");
  const auto arguments = std::make_shared<RenderArguments>();
  verb->add_option("MESH", arguments->path, kMeshInputHelp)->required();
  verb->add_option("-o,--output", arguments->output, "Picture to write: .png (without it: the name of the mesh)");
  verb->add_option("--size", arguments->size, "Pixels: WxH")->capture_default_str();
  verb->add_option("--view", arguments->view, "front, back, left, right, top, bottom, iso, or AZIMUTH,ELEVATION")
      ->capture_default_str();
  verb->add_option("--up", arguments->up, "Axis of the mesh that points up: x, y, z, -x, -y or -z")
      ->capture_default_str();
  verb->add_option("--zoom", arguments->zoom, "2: twice as large, around the middle; 1: all of the mesh just fits")
      ->capture_default_str();
  verb->add_flag("--axes", arguments->axes, "Mark where the axes point: R L A P S I in LPS and RAS, else x y z");
  verb->add_option("--background", arguments->background, "#rrggbb, a name such as white or black, or transparent")
      ->capture_default_str();
  verb->add_option("--color", arguments->colour, "Of the surface: #rrggbb, or a name such as white, red or bone")
      ->capture_default_str();
  verb->add_option(
      "--color-by", arguments->colour_by,
      "quality: by the number at each vertex that mesh --color-by and compare --distances write, dark to bright");
  verb->add_option("--range", arguments->range,
                   "LOW,HIGH: numbers at the ends of the colours (default: all there are)");
  verb->add_flag("--no-color-bar", arguments->no_color_bar,
                 "With --color-by: no bar of the colours and their numbers at the right");
  verb->add_option("--shading", arguments->shading, "smooth or flat")->capture_default_str();
  verb->add_flag("--wireframe", arguments->wireframe, "Draw the edges of the triangles");
  verb->add_option("--samples", arguments->samples, "Samples along each side of a pixel")->capture_default_str();
  add_external_option(*verb, arguments->reading);
  verb->add_option("--threads", arguments->threads, "Threads, or all; never changes the result")->capture_default_str();
  add_clobber_option(*verb, arguments->no_clobber);
  verb->add_flag("--quiet", arguments->quiet, "Say nothing but errors");
  verb->footer(kRenderExamples);
  verb->callback([arguments] { run_render(*arguments); });
}

}  // namespace isoweave::cli
