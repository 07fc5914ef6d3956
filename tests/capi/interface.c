// The C interface from C99: every call, beside the command line where that says the same.
//   isoweave_c_tests [PROGRAM]
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "support.h"

static void write_samples(const float* samples) {
  FILE* file = fopen("c_volume.raw", "wb");
  EXPECT(file != NULL && fwrite(samples, sizeof(float), SAMPLES, file) == SAMPLES);
  if (file != NULL) fclose(file);
}

// The digest that the command line prints for the same volume and options.
static void digest_of_program(const char* program, const char* extractor, char digest[17]) {
  char command[1024];
  static char report[1 << 16];
  snprintf(command, sizeof command,
           "'%s' mesh c_volume.raw --raw 36x36x36:float32 --spacing 0.5,0.75,1.25 --origin 3,0,0 --iso 0 "
           "--error 0.3vox --extractor %s --quiet -o c_program.ply --report c_report.json",
           program, extractor);
  EXPECT(system(command) == 0);
  FILE* file = fopen("c_report.json", "rb");
  EXPECT(file != NULL);
  if (file == NULL) return;
  report[fread(report, 1, sizeof report - 1, file)] = 0;
  fclose(file);
  text_in(report, "digest", digest, 17);
}

// ------------------------------------------------------------------------------------------ sources, sinks, progress

typedef struct {
  const float* samples;
  int64_t stop_at;  // the slice at which reading stops the run; -1: none
} Source;

static int32_t read_slices(void* context, int64_t first, int64_t count, void* out) {
  const Source* source = context;
  if (source->stop_at >= 0 && first + count > source->stop_at) return 7;
  const size_t slice = (size_t)SIDE * SIDE;
  memcpy(out, source->samples + (size_t)first * slice, (size_t)count * slice * sizeof(float));
  return 0;
}

typedef struct {
  float points[3 * SAMPLES];
  uint32_t corners[3 * SAMPLES];
  size_t vertices, triangles;
  int finished, stop;
} Sink;

static int32_t append(void* context, const iw_piece* piece) {
  Sink* sink = context;
  if (sink->stop) return 1;
  if (piece->vertices > 0)
    memcpy(sink->points + 3 * sink->vertices, piece->points, 3 * piece->vertices * sizeof(float));
  for (uint64_t n = 0; n < 3 * piece->triangles; ++n)
    sink->corners[3 * sink->triangles + n] = (uint32_t)piece->corners[n];
  sink->vertices += piece->vertices;
  sink->triangles += piece->triangles;
  return 0;
}

static int32_t finish(void* context) {
  ((Sink*)context)->finished = 1;
  return 0;
}

static int32_t count_and_stop(void* context, const iw_progress* progress) {
  int* calls = context;
  EXPECT(progress->layer > 0 && progress->layer <= progress->layers);
  return ++*calls == 3;
}

// ------------------------------------------------------------------------------------------------------------- tests

static void test_digests(const float* samples, const char* program) {
  char wanted[17] = "", found[17];
  iw_simplify_options simplify = within("0.3vox");
  iw_mesh_options options = {.struct_size = sizeof options};
  options.simplify = &simplify;

  iw_volume* volume = volume_of(samples);
  iw_output memory = {.struct_size = sizeof memory};
  EXPECT(is(iw_mesh_volume(volume, &options, NULL, &memory, 1, &result), IW_DONE));
  keep_digest(wanted);
  EXPECT(strlen(wanted) == 16);
  EXPECT(number_in(result.report, "open_edges") == 0 && number_in(result.report, "components") == 2);

  iw_mesh_arrays arrays = {.struct_size = sizeof arrays};
  EXPECT(is(iw_get_mesh_arrays(memory.mesh, &arrays, &result), IW_DONE));
  EXPECT(arrays.triangles > 100 && 2 * (arrays.vertices - 4) == arrays.triangles);  // two spheres
  iw_mesh* copy = NULL;
  EXPECT(is(iw_mesh_from_arrays(&arrays, &copy, &result), IW_DONE));
  EXPECT(is(iw_check_mesh(copy, 1, 0, &result), IW_DONE));
  keep_digest(found);
  EXPECT(strcmp(found, wanted) == 0);
  EXPECT(number_in(result.report, "euler") == 4 && number_in(result.report, "pairs") == 0);
  iw_free_mesh(copy);

  // The same volume once more, by a callback, into a sink.
  Source source = {samples, -1};
  Sink* kept = calloc(1, sizeof *kept);
  const iw_volume_info info = info_of_samples();
  const iw_source slices = {sizeof slices, &source, read_slices, 0};
  const iw_sink pieces = {sizeof pieces, kept, append, finish};
  iw_volume* streamed = NULL;
  EXPECT(is(iw_volume_from_source(&info, &slices, &streamed, &result), IW_DONE));
  iw_output to_sink = {.struct_size = sizeof to_sink};
  to_sink.sink = &pieces;
  iw_run run = {.struct_size = sizeof run};
  run.slab = 3;
  for (int again = 0; again < 2; ++again) {  // a volume may be read any number of times
    memset(kept, 0, sizeof *kept);
    EXPECT(is(iw_mesh_volume(streamed, &options, &run, &to_sink, 1, &result), IW_DONE));
    keep_digest(found);
    EXPECT(strcmp(found, wanted) == 0 && kept->finished);
    EXPECT(kept->vertices == arrays.vertices && kept->triangles == arrays.triangles);
  }
  iw_mesh_arrays of_sink = {.struct_size = sizeof of_sink};
  of_sink.vertices = kept->vertices;
  of_sink.triangles = kept->triangles;
  of_sink.points = kept->points;
  of_sink.corners = kept->corners;
  EXPECT(is(iw_mesh_from_arrays(&of_sink, &copy, &result), IW_DONE));
  EXPECT(is(iw_check_mesh(copy, 0, 0, &result), IW_DONE));
  keep_digest(found);
  EXPECT(strcmp(found, wanted) == 0);
  iw_free_mesh(copy);
  free(kept);
  iw_free_volume(streamed);

  // From a file into a file.
  write_samples(samples);
  const double spacing[3] = {0.5, 0.75, 1.25}, origin[3] = {3, 0, 0};
  iw_open_options raw = {.struct_size = sizeof raw};
  raw.raw = "36x36x36:float32";
  raw.spacing = spacing;
  raw.origin = origin;
  iw_volume* file = NULL;
  EXPECT(is(iw_open_volume("c_volume.raw", &raw, &file, &result), IW_DONE));
  iw_output to_file = {.struct_size = sizeof to_file};
  to_file.path = "c_mesh.ply";
  EXPECT(is(iw_mesh_volume(file, &options, NULL, &to_file, 1, &result), IW_DONE));
  keep_digest(found);
  EXPECT(strcmp(found, wanted) == 0 && to_file.mesh == NULL);
  iw_mesh* read = NULL;
  EXPECT(is(iw_read_mesh("c_mesh.ply", 0, &read, &result), IW_DONE));
  EXPECT(is(iw_check_mesh(read, 0, 0, &result), IW_DONE));
  keep_digest(found);
  EXPECT(strcmp(found, wanted) == 0);
  EXPECT(is(iw_write_mesh(memory.mesh, "c_again.stl", 0, &result), IW_DONE));
  EXPECT(exists("c_again.stl"));

  static const char* const extractors[] = {"cubes", "trilinear", "tetrahedra", "dual"};
  for (int32_t n = IW_EXTRACTOR_CUBES; program != NULL && n <= IW_EXTRACTOR_DUAL; ++n) {
    char by_program[17] = "", named[16];
    digest_of_program(program, extractors[n], by_program);
    options.extractor = n;
    EXPECT(is(iw_mesh_volume(file, &options, NULL, &to_file, 1, &result), IW_DONE));
    keep_digest(found);
    text_in(result.report, "extractor", named, sizeof named);
    EXPECT(strcmp(by_program, found) == 0 && strcmp(named, extractors[n]) == 0);
    EXPECT((n == IW_EXTRACTOR_CUBES) == (strcmp(found, wanted) == 0));
  }
  iw_free_mesh(read);
  iw_free_mesh(memory.mesh);
  iw_free_volume(file);
  iw_free_volume(volume);
}

static void test_volumes(const float* samples) {
  iw_volume* volume = volume_of(samples);
  iw_volume_info info = {.struct_size = sizeof info};
  EXPECT(is(iw_get_volume_info(volume, &info, &result), IW_DONE));
  EXPECT(info.dims[1] == SIDE && info.spacing[2] == 1.25 && info.slope == 1 && info.direction[4] == 1);
  EXPECT(strcmp(info.path, "volume") == 0);

  const int64_t first[3] = {2, 3, 4}, end[3] = {30, 31, 33};
  iw_volume* part = NULL;
  EXPECT(is(iw_crop_volume(volume, first, end, &part, &result), IW_DONE));
  iw_free_volume(volume);  // the part keeps what it needs
  float slice[28 * 28];
  EXPECT(is(iw_read_slices(part, 5, 1, slice, sizeof slice, &result), IW_DONE));
  EXPECT(slice[28 * 7 + 11] == samples[(9 * SIDE + 10) * SIDE + 13]);
  EXPECT(is(iw_read_slices(part, 5, 1, slice, sizeof slice - 1, &result), IW_BAD_ARGUMENT));
  EXPECT(is(iw_read_slices(part, 29, 1, slice, sizeof slice, &result), IW_BAD_ARGUMENT));
  EXPECT(is(iw_read_slices(part, INT64_MAX, INT64_MAX, slice, sizeof slice, &result), IW_BAD_ARGUMENT));

  iw_volume* half = NULL;
  EXPECT(is(iw_downsample_volume(part, 2, &half, &result), IW_DONE));
  EXPECT(is(iw_get_volume_info(half, &info, &result), IW_DONE));
  EXPECT(info.dims[0] == 14 && info.dims[2] == 15 && info.spacing[0] == 1);

  EXPECT(is(iw_histogram(part, NULL, &result), IW_DONE));
  float least = INFINITY;
  for (int k = 4; k < 33; ++k)
    for (int j = 3; j < 31; ++j)
      for (int i = 2; i < 30; ++i) least = fminf(least, samples[(k * SIDE + j) * SIDE + i]);
  EXPECT(number_in(result.report, "min") == (double)least && number_in(result.report, "nan") == 0);

  iw_mesh_options options = {.struct_size = sizeof options};
  EXPECT(is(iw_forecast(part, &options, NULL, &result), IW_DONE));
  EXPECT(number_in(result.report, "triangles_extracted") > 0 && number_in(result.report, "peak_bytes") > 0);
  iw_free_volume(half);
  iw_free_volume(part);
}

// Two boxes of labels, which touch.
static void test_labels(void) {
  static uint8_t map[SAMPLES];
  for (int k = 5; k < 20; ++k)
    for (int j = 5; j < 20; ++j)
      for (int i = 5; i < 20; ++i) map[(k * SIDE + j) * SIDE + i] = i < 12 ? 3 : 7;
  iw_volume_info info = info_of_samples();
  info.type = IW_UINT8;
  iw_volume* volume = NULL;
  EXPECT(is(iw_volume_in_memory(&info, map, sizeof map, &volume, &result), IW_DONE));
  EXPECT(is(iw_find_labels(volume, NULL, &result), IW_DONE));
  EXPECT(strstr(result.report, "{\"label\":3,\"samples\":1575},{\"label\":7,\"samples\":1800}") != NULL);

  iw_output outputs[2] = {{.struct_size = sizeof outputs[0]}, {.struct_size = sizeof outputs[0]}};
  outputs[0].label = "7";
  outputs[1].label = "3";
  EXPECT(is(iw_mesh_labels(volume, NULL, NULL, outputs, 2, &result), IW_DONE));
  for (int n = 0; n < 2; ++n) {
    EXPECT(is(iw_check_mesh(outputs[n].mesh, 0, 0, &result), IW_DONE));
    const double volume_of_box = (n == 0 ? 8 : 7) * 15 * 15 * 0.5 * 0.75 * 1.25;
    EXPECT(fabs(number_in(result.report, "volume") / volume_of_box - 1) < 0.1);
    iw_free_mesh(outputs[n].mesh);
  }
  outputs[0].label = "seven";
  outputs[0].mesh = NULL;
  EXPECT(is(iw_mesh_labels(volume, NULL, NULL, outputs, 2, &result), IW_BAD_ARGUMENT));
  EXPECT(outputs[0].mesh == NULL);
  iw_free_volume(volume);
}

static void test_meshes(const float* samples) {
  iw_volume* volume = volume_of(samples);
  iw_simplify_options levels = {.struct_size = sizeof levels};
  levels.levels = "0.05vox,0.4vox";
  iw_mesh_options options = {.struct_size = sizeof options};
  options.simplify = &levels;
  options.normals = IW_NORMALS_GRADIENT;
  iw_output outputs[2] = {{.struct_size = sizeof outputs[0]}, {.struct_size = sizeof outputs[0]}};
  EXPECT(is(iw_mesh_volume(volume, &options, NULL, outputs, 2, &result), IW_DONE));
  iw_mesh_arrays fine = {.struct_size = sizeof fine}, coarse = {.struct_size = sizeof coarse};
  EXPECT(is(iw_get_mesh_arrays(outputs[0].mesh, &fine, &result), IW_DONE));
  EXPECT(is(iw_get_mesh_arrays(outputs[1].mesh, &coarse, &result), IW_DONE));
  EXPECT(fine.triangles > 2 * coarse.triangles && coarse.normals != NULL && coarse.values == NULL);

  float* distances = malloc(coarse.vertices * sizeof(float));
  iw_compare_options compare = {.struct_size = sizeof compare};
  compare.samples = 20000;
  compare.distances = distances;
  EXPECT(is(iw_compare_meshes(outputs[1].mesh, outputs[0].mesh, &compare, &result), IW_DONE));
  const double rms = number_in(result.report, "rms");
  EXPECT(rms > 0 && rms < 0.4);
  float farthest = 0;
  for (uint64_t n = 0; n < coarse.vertices; ++n) farthest = fmaxf(farthest, distances[n]);
  EXPECT(farthest > 0 && farthest < 1);
  free(distances);

  iw_simplify_options number = {.struct_size = sizeof number};
  number.ratio = 0.25;
  iw_output simplified = {.struct_size = sizeof simplified};
  EXPECT(is(iw_simplify_mesh(outputs[0].mesh, &number, NULL, &simplified, 1, &result), IW_DONE));
  const double triangles = number_in(strstr(result.report, "\"sweep\""), "triangles");  // before it: the input's
  EXPECT(triangles <= 0.25 * (double)fine.triangles + 1 && triangles > 0.2 * (double)fine.triangles);
  const iw_simplify_options nothing = {.struct_size = sizeof nothing};
  iw_output none = {.struct_size = sizeof none};
  EXPECT(is(iw_simplify_mesh(outputs[0].mesh, &nothing, NULL, &none, 1, &result), IW_BAD_ARGUMENT));

  // A share of a volume's triangles, and the largest component alone.
  iw_simplify_options largest = {.struct_size = sizeof largest};
  largest.ratio = 0.5;
  largest.largest = 1;
  options.simplify = &largest;
  iw_output alone = {.struct_size = sizeof alone};
  EXPECT(is(iw_mesh_volume(volume, &options, NULL, &alone, 1, &result), IW_DONE));
  EXPECT(number_in(result.report, "components") == 1 && number_in(result.report, "components_dropped") == 1);
  iw_free_mesh(alone.mesh);
  iw_free_mesh(simplified.mesh);
  iw_free_mesh(outputs[0].mesh);
  iw_free_mesh(outputs[1].mesh);
  iw_free_volume(volume);
}

static void test_stops(const float* samples) {
  const iw_volume_info info = info_of_samples();
  Source source = {samples, 20};
  const iw_source slices = {sizeof slices, &source, read_slices, 0};
  iw_volume* volume = NULL;
  EXPECT(is(iw_volume_from_source(&info, &slices, &volume, &result), IW_DONE));
  iw_output file = {.struct_size = sizeof file};
  file.path = "c_stopped.ply";
  remove(file.path);  // what a test that failed left
  EXPECT(is(iw_mesh_volume(volume, NULL, NULL, &file, 1, &result), IW_STOPPED));
  EXPECT(strstr(result.message, ": stopped by its source (7)") != NULL);

  source.stop_at = -1;
  int calls = 0;
  iw_run run = {.struct_size = sizeof run};
  run.slab = 2;
  run.context = &calls;
  run.progress = count_and_stop;
  EXPECT(is(iw_mesh_volume(volume, NULL, &run, &file, 1, &result), IW_STOPPED));
  EXPECT(calls == 3);

  Sink* kept = calloc(1, sizeof *kept);
  kept->stop = 1;
  const iw_sink pieces = {sizeof pieces, kept, append, NULL};
  iw_output to_sink = {.struct_size = sizeof to_sink};
  to_sink.sink = &pieces;
  EXPECT(is(iw_mesh_volume(volume, NULL, NULL, &to_sink, 1, &result), IW_STOPPED));
  free(kept);

  iw_stop* stop = iw_stop_new();
  iw_stop_set(stop);
  run.progress = NULL;
  run.stop = stop;
  EXPECT(is(iw_mesh_volume(volume, NULL, &run, &file, 1, &result), IW_STOPPED));
  EXPECT(is(iw_histogram(volume, stop, &result), IW_STOPPED));
  EXPECT(!exists("c_stopped.ply"));
  iw_stop_free(stop);
  iw_free_volume(volume);
}

// A cap on memory leaves room for what a source holds, and nothing is read where there is none.
static void test_held_bytes(const float* samples) {
  const iw_volume_info info = info_of_samples();
  Source source = {samples, -1};
  iw_source slices = {sizeof slices, &source, read_slices, 0};
  iw_run capped = {.struct_size = sizeof capped};
  capped.memory = 1000000000;
  iw_output none = {.struct_size = sizeof none};
  iw_volume* volume = NULL;
  EXPECT(is(iw_volume_from_source(&info, &slices, &volume, &result), IW_DONE));
  EXPECT(is(iw_mesh_volume(volume, NULL, &capped, &none, 1, &result), IW_DONE));
  iw_free_mesh(none.mesh);
  none.mesh = NULL;
  iw_free_volume(volume);

  slices.held_bytes = 1000000000;
  source.stop_at = 0;
  EXPECT(is(iw_volume_from_source(&info, &slices, &volume, &result), IW_DONE));
  EXPECT(is(iw_mesh_volume(volume, NULL, &capped, &none, 1, &result), IW_OVER_MEMORY));
  iw_free_volume(volume);
  slices.held_bytes = UINT64_MAX;
  EXPECT(is(iw_volume_from_source(&info, &slices, &volume, &result), IW_BAD_ARGUMENT));

  // A program that was built before the member was there.
  source.stop_at = -1;
  slices.struct_size = offsetof(iw_source, held_bytes);
  EXPECT(is(iw_volume_from_source(&info, &slices, &volume, &result), IW_DONE));
  EXPECT(is(iw_mesh_volume(volume, NULL, &capped, &none, 1, &result), IW_DONE));
  iw_free_mesh(none.mesh);
  iw_free_volume(volume);

  // Samples that 63 bits can count, and bytes of them that they cannot.
  iw_volume_info huge = info;
  huge.dims[0] = INT64_C(1) << 61;
  huge.dims[1] = huge.dims[2] = 1;
  huge.type = IW_FLOAT64;
  EXPECT(is(iw_volume_from_source(&huge, &slices, &volume, &result), IW_BAD_ARGUMENT));
}

// No struct ends with padding: a member that a later header has there would be read from programs that never set it.
// `last` is the last member.
#define EXPECT_FULL(type, last) EXPECT(sizeof(type) == offsetof(type, last) + sizeof(((type*)NULL)->last))

static void test_structs(const float* samples) {
  EXPECT_FULL(iw_result, report);
  EXPECT_FULL(iw_volume_info, path);
  EXPECT_FULL(iw_open_options, reserved);
  EXPECT_FULL(iw_source, held_bytes);
  EXPECT_FULL(iw_mesh_arrays, space);
  EXPECT_FULL(iw_compare_options, distances);
  EXPECT_FULL(iw_simplify_options, reserved);
  EXPECT_FULL(iw_mesh_options, reserved);
  EXPECT_FULL(iw_progress, bytes);
  EXPECT_FULL(iw_run, reserved);
  EXPECT_FULL(iw_piece, offset);
  EXPECT_FULL(iw_sink, finish);
  EXPECT_FULL(iw_output, iso);

  iw_volume *volume = volume_of(samples), *other = NULL;
  iw_output memory = {.struct_size = sizeof memory};
  iw_open_options open = {.struct_size = sizeof open};
  iw_simplify_options simplify = within("0");
  iw_mesh_options options = {.struct_size = sizeof options};
  iw_run run = {.struct_size = sizeof run};
  open.reserved = simplify.reserved = options.reserved = run.reserved = 1;
  EXPECT(is(iw_open_volume("c_missing.nrrd", &open, &other, &result), IW_BAD_ARGUMENT));
  EXPECT(strcmp(result.message, "reserved: expected 0, found 1") == 0);
  EXPECT(is(iw_mesh_volume(volume, &options, NULL, &memory, 1, &result), IW_BAD_ARGUMENT));
  EXPECT(is(iw_mesh_volume(volume, NULL, &run, &memory, 1, &result), IW_BAD_ARGUMENT));
  options.reserved = 0;
  options.simplify = &simplify;
  EXPECT(is(iw_mesh_volume(volume, &options, NULL, &memory, 1, &result), IW_BAD_ARGUMENT));
  simplify.reserved = 0;
  EXPECT(is(iw_mesh_volume(volume, &options, NULL, &memory, 1, &result), IW_DONE));
  iw_free_mesh(memory.mesh);
  iw_free_volume(volume);
}

static void test_faults(const float* samples) {
  iw_volume *volume = volume_of(samples), *other = NULL;
  iw_mesh* mesh = NULL;
  iw_output memory = {.struct_size = sizeof memory};
  EXPECT(is(iw_open_volume("c_missing.nrrd", NULL, &other, &result), IW_BAD_INPUT));
  EXPECT(strstr(result.message, "c_missing.nrrd") != NULL && strchr(result.message, '\n') == NULL && other == NULL);
  EXPECT(is(iw_open_volume(NULL, NULL, &other, &result), IW_BAD_ARGUMENT));
  EXPECT(is(iw_read_mesh("c_missing.ply", 0, &mesh, &result), IW_BAD_INPUT));
  EXPECT(is(iw_mesh_volume(NULL, NULL, NULL, &memory, 1, &result), IW_BAD_ARGUMENT));
  EXPECT(is(iw_mesh_volume(volume, NULL, NULL, NULL, 1, &result), IW_BAD_ARGUMENT));
  EXPECT(is(iw_mesh_volume(volume, NULL, NULL, NULL, 0, &result), IW_BAD_ARGUMENT));

  iw_output nowhere = {.struct_size = sizeof nowhere};
  nowhere.path = "c_no_such_folder/mesh.ply";
  EXPECT(is(iw_mesh_volume(volume, NULL, NULL, &nowhere, 1, &result), IW_CANNOT_WRITE));

  iw_run small = {.struct_size = sizeof small};
  small.memory = 1000;
  EXPECT(is(iw_mesh_volume(volume, NULL, &small, &memory, 1, &result), IW_OVER_MEMORY));

  iw_mesh_options options = {.struct_size = sizeof options};
  options.iso = (double)NAN;
  EXPECT(is(iw_mesh_volume(volume, &options, NULL, &memory, 1, &result), IW_BAD_ARGUMENT));
  options.iso = 0;
  options.normals = 3;
  EXPECT(is(iw_mesh_volume(volume, &options, NULL, &memory, 1, &result), IW_BAD_ARGUMENT));
  options.normals = IW_NORMALS_NONE;
  options.extractor = 4;
  EXPECT(is(iw_mesh_volume(volume, &options, NULL, &memory, 1, &result), IW_BAD_ARGUMENT));
  options.extractor = IW_EXTRACTOR_CUBES;
  iw_simplify_options simplify = within("0.2furlong");
  options.simplify = &simplify;
  EXPECT(is(iw_mesh_volume(volume, &options, NULL, &memory, 1, &result), IW_BAD_ARGUMENT));
  EXPECT(strstr(result.message, "0.2furlong") != NULL);

  // Structs of a header that is older, and of one that this library does not know.
  options.struct_size = offsetof(iw_mesh_options, inside_below);
  simplify = within("0");
  options.inside_below = 77;
  EXPECT(is(iw_mesh_volume(volume, &options, NULL, &memory, 1, &result), IW_DONE));
  EXPECT(strstr(result.report, "\"inside\":\"above\"") != NULL);
  iw_free_mesh(memory.mesh);
  memory.mesh = NULL;
  options.struct_size = sizeof options + 8;
  EXPECT(is(iw_mesh_volume(volume, &options, NULL, &memory, 1, &result), IW_BAD_ARGUMENT));
  options.struct_size = offsetof(iw_mesh_options, simplify) + sizeof options.simplify / 2;  // half a pointer
  EXPECT(is(iw_mesh_volume(volume, &options, NULL, &memory, 1, &result), IW_BAD_ARGUMENT));
  EXPECT(strstr(result.message, "struct_size") != NULL);
  memory.struct_size = 8;
  EXPECT(is(iw_mesh_volume(volume, NULL, NULL, &memory, 1, &result), IW_BAD_ARGUMENT));

  const float point[3] = {0, 0, 0};
  const uint32_t corner[3] = {0, 0, 1};
  iw_mesh_arrays wrong = {sizeof wrong, 1, 1, point, corner, NULL, NULL, {0, 0, 0}, NULL, NULL};
  EXPECT(is(iw_mesh_from_arrays(&wrong, &mesh, &result), IW_DONE));
  EXPECT(is(iw_check_mesh(mesh, 0, 0, &result), IW_BAD_ARGUMENT));  // a corner of no vertex
  iw_free_mesh(mesh);
  EXPECT(iw_check_mesh(NULL, 0, 0, NULL) == IW_BAD_ARGUMENT);

  iw_volume_info info = info_of_samples();
  info.dims[0] = INT64_MAX;
  EXPECT(is(iw_volume_in_memory(&info, samples, 4, &other, &result), IW_BAD_ARGUMENT));
  info.dims[0] = SIDE;
  EXPECT(is(iw_volume_in_memory(&info, samples, 4, &other, &result), IW_BAD_ARGUMENT));
  iw_free_volume(volume);
  iw_free_volume(NULL);
  iw_free_mesh(NULL);
}

int main(int count, char** arguments) {
  EXPECT(iw_abi_version() == IW_ABI_VERSION && strlen(iw_version()) >= 5);
  float* samples = malloc(SAMPLES * sizeof(float));
  if (samples == NULL) return 1;
  fill(samples);
  test_digests(samples, count > 1 ? arguments[1] : NULL);
  test_volumes(samples);
  test_labels();
  test_isos(samples);
  test_meshes(samples);
  test_stops(samples);
  test_held_bytes(samples);
  test_checkpoints(samples);
  test_structs(samples);
  test_faults(samples);
  iw_result_clear(&result);
  free(samples);
  printf("%d faults\n", faults);
  return faults != 0;
}
