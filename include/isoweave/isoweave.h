// The C interface (C99): volumes to simplified triangle surfaces, for C and for every language that can call C.
//
// Handles are opaque. Every struct begins with its size, and a struct of zeros with its size set has the safe defaults:
//   iw_mesh_options options = {.struct_size = sizeof options};
// So a program goes on working with a later library whose structs have more members at their ends. Members that are
// reserved must be 0: a later library gives them a meaning.
//
// Every call that can fail returns a status, and says more in an iw_result, which may be NULL. No C++ exception leaves
// a call. Nothing is printed, nothing is global, and no thread outlives a call. Calls on different handles are
// independent. Volumes and meshes may be used by several threads at the same time.
//
// Arrays of samples and coordinates are in the order x, y, z: x is fastest. Strings are UTF-8 and end with 0. A string
// or array that is handed over is used during the call only, unless a comment says otherwise.
#ifndef ISOWEAVE_ISOWEAVE_H
#define ISOWEAVE_ISOWEAVE_H

#include <stddef.h>
#include <stdint.h>

#pragma GCC visibility push(default)
// NOLINTBEGIN(readability-identifier-naming,modernize-*): C99, whose names begin with iw_
#ifdef __cplusplus
extern "C" {
#endif

// The number of this interface. It changes when a call or a struct means something else than before, and not when one
// is added.
#define IW_ABI_VERSION 1

uint32_t iw_abi_version(void);  // of the library, to be compared with IW_ABI_VERSION
const char* iw_version(void);   // of isoweave, such as "0.1.0"

// The statuses of calls. They are the exit codes of the command line, as far as that has one.
typedef int32_t iw_status;
enum {
  IW_DONE = 0,
  IW_FAILED = 1,        // a fault of the library
  IW_BAD_ARGUMENT = 2,  // options out of range or that do not go together
  IW_BAD_INPUT = 3,     // a volume or mesh that cannot be found, understood or read to its end
  IW_CANNOT_WRITE = 4,  // an output that cannot be created, written or represented in its format
  IW_OVER_MEMORY = 5,   // more memory than was given, or than there is
  IW_DEVICE_ERROR = 6,  // no usable device, or the device failed
  IW_STOPPED = 130      // a callback or an iw_stop ended the run; no file is left behind
};

// Facts about a call beside its status. The call sets both; iw_result_clear frees them and sets them to NULL. A result
// that is used again is cleared by the call.
typedef struct iw_result {
  size_t struct_size;
  char* message;  // one line: file or option, expected, found; NULL where the status is IW_DONE
  char* report;   // JSON with the keys of the command line's reports; NULL where the call has none
} iw_result;

void iw_result_clear(iw_result* result);

// A wish to stop, for any number of runs. iw_stop_set may be called by any thread and by signal handlers; it cannot be
// taken back. A stop must outlive the calls that it was given to.
typedef struct iw_stop iw_stop;
iw_stop* iw_stop_new(void);  // NULL without memory
void iw_stop_set(iw_stop* stop);
void iw_stop_free(iw_stop* stop);

// ---------------------------------------------------------------------------------------------------------- volumes

enum {  // sample types
  IW_UINT8 = 0,
  IW_INT8,
  IW_UINT16,
  IW_INT16,
  IW_UINT32,
  IW_INT32,
  IW_UINT64,
  IW_INT64,
  IW_FLOAT32,
  IW_FLOAT64
};
enum { IW_SPACE_UNKNOWN = 0, IW_SPACE_LPS, IW_SPACE_RAS };  // the meaning of the world axes

// A volume: the description from which slices are read anew by every run, so it may be meshed any number of times.
typedef struct iw_volume iw_volume;

// position(i, j, k) = origin + direction * (spacing * (i, j, k))
typedef struct iw_volume_info {
  size_t struct_size;
  int64_t dims[3];      // nx, ny, nz; each >= 1
  int32_t type;         // IW_UINT8 ...
  int32_t space;        // IW_SPACE_UNKNOWN ...
  double spacing[3];    // > 0; all 0: 1
  double origin[3];     // of the first sample
  double direction[9];  // row-major; column a is axis a, unit length; all 0: the axes
  double slope;         // value = slope * stored + intercept; 0: 1
  double intercept;
  const char* unit;  // "mm", "um", "nm", "m"; NULL or empty: not said
  const char* path;  // the name in messages; NULL: "volume"
} iw_volume_info;

// How a volume file is opened: as OpenOptions of volume.hpp.
typedef struct iw_open_options {
  size_t struct_size;
  const char* raw;         // "WxHxD:type[:big][:skip=N]": headerless data
  const double* spacing;   // three numbers that override the file's
  const double* origin;    // likewise
  const char* dataset;     // path or name of an array in the file or folder
  const char* series;      // UID of a DICOM series
  const int64_t* level;    // of an image kept at several sizes; NULL: not said
  const int64_t* channel;  // NULL: not said
  const int64_t* time;     // NULL: not said
  int32_t no_external;     // 1: a header may not name other files
  int32_t reserved;        // 0
} iw_open_options;

// Opens a file or folder of any format of the library. options: NULL for the defaults. A pipe can be read by one run.
iw_status iw_open_volume(const char* path, const iw_open_options* options, iw_volume** volume, iw_result* result);

// A volume in memory: dims[0] * dims[1] * dims[2] samples, x fastest, in the machine's byte order. They are not copied,
// and must stay as they are until the volume, and every volume made from it, is freed.
iw_status iw_volume_in_memory(const iw_volume_info* info, const void* samples, size_t bytes, iw_volume** volume,
                              iw_result* result);

// A source of slices by a callback. Each run reads slices in ascending order from 0 on, and may skip some. A run may
// call it from a thread of its own, but never from two at the same time.
typedef struct iw_source {
  size_t struct_size;
  void* context;
  // Writes the slices first ... first + count - 1 to `out`, densely packed. Returns 0, or another number to stop the
  // run, which returns IW_STOPPED then and a message that ends with "stopped by its source (NUMBER)".
  int32_t (*read)(void* context, int64_t first, int64_t count, void* out);
  // The most bytes that the callback holds between and during calls, beside `out`: below 2^63. Forecasts and caps on
  // memory count them.
  uint64_t held_bytes;
} iw_source;

// A volume whose slices come from a callback. `context` must outlive the volume and every volume made from it.
iw_status iw_volume_from_source(const iw_volume_info* info, const iw_source* source, iw_volume** volume,
                                iw_result* result);

// A part of a volume, [first, end) along each axis, at its place in the whole; and a volume of means of blocks of
// step x step x step samples. Both keep what they need of `volume`, which may be freed before them.
iw_status iw_crop_volume(const iw_volume* volume, const int64_t first[3], const int64_t end[3], iw_volume** part,
                         iw_result* result);
iw_status iw_downsample_volume(const iw_volume* volume, int64_t step, iw_volume** smaller, iw_result* result);

// Fills in what `info` has room for. Strings stay valid until the volume is freed. The report is the `input` part of a
// run's report: format, notes and what else the header says.
iw_status iw_get_volume_info(const iw_volume* volume, iw_volume_info* info, iw_result* result);

// Reads slices in the type of the samples, densely packed.
iw_status iw_read_slices(const iw_volume* volume, int64_t first, int64_t count, void* out, size_t bytes,
                         iw_result* result);

// Reads the whole volume. The report has min, max, nan, infinite, histogram (256 counts) and suggested_iso, Otsu's
// threshold; null without two different values. stop: may be NULL.
iw_status iw_histogram(const iw_volume* volume, const iw_stop* stop, iw_result* result);

// Finds the labels of a label map but 0. The report is a list of {"label", "samples"}. stop: may be NULL.
iw_status iw_find_labels(const iw_volume* volume, const iw_stop* stop, iw_result* result);

void iw_free_volume(iw_volume* volume);

// ----------------------------------------------------------------------------------------------------------- meshes

// A triangle mesh in memory.
typedef struct iw_mesh iw_mesh;

// The arrays of a mesh. A vertex lies at offset + its point.
typedef struct iw_mesh_arrays {
  size_t struct_size;
  uint64_t vertices, triangles;
  const float* points;      // 3 for each vertex
  const uint32_t* corners;  // 3 for each triangle, counter-clockwise seen from outside
  const float* normals;     // 3 for each vertex, or NULL
  const float* values;      // 1 for each vertex, or NULL
  double offset[3];
  const char* unit;   // NULL or empty: not said
  const char* space;  // "LPS", "RAS" or "index"; NULL or empty: not said
} iw_mesh_arrays;

// A mesh of copies of the arrays.
iw_status iw_mesh_from_arrays(const iw_mesh_arrays* arrays, iw_mesh** mesh, iw_result* result);

// Reads a mesh file of any format of the library. no_external: 1, a file may not name others. The report has `notes`.
iw_status iw_read_mesh(const char* path, int32_t no_external, iw_mesh** mesh, iw_result* result);

// Fills in what `arrays` has room for. Arrays and strings stay valid until the mesh is freed.
iw_status iw_get_mesh_arrays(const iw_mesh* mesh, iw_mesh_arrays* arrays, iw_result* result);

// Writes a mesh file in the format of the name's ending: complete or absent. Normals and values are written where the
// mesh has them and the format has a place. compress: 1, as MeshFileOptions::compress.
iw_status iw_write_mesh(const iw_mesh* mesh, const char* path, int32_t compress, iw_result* result);

// Counts of a mesh and its digest, as check_mesh of measure.hpp, into the report. self_intersections: 1, those too.
// threads: 0 for all.
iw_status iw_check_mesh(const iw_mesh* mesh, int32_t self_intersections, int32_t threads, iw_result* result);

typedef struct iw_compare_options {
  size_t struct_size;
  uint64_t samples;  // on each mesh; 0: 500,000
  int32_t threads;   // 0: all
  float* distances;  // NULL, or room for the distance of every vertex of a to b
} iw_compare_options;

// Distances between two meshes both ways, in the unit of a, into the report. b is brought to a's unit and space first.
iw_status iw_compare_meshes(const iw_mesh* a, const iw_mesh* b, const iw_compare_options* options, iw_result* result);

void iw_free_mesh(iw_mesh* mesh);

// ------------------------------------------------------------------------------------------------------------- runs

enum { IW_QUALITY_NORMAL = 0, IW_QUALITY_FAST, IW_QUALITY_FINE };
enum { IW_NORMALS_NONE = 0, IW_NORMALS_GRADIENT, IW_NORMALS_QUADRIC };
enum { IW_OUTPUT_AS_VOLUME = 0, IW_OUTPUT_LPS, IW_OUTPUT_RAS, IW_OUTPUT_INDEX };
enum { IW_EXTRACTOR_CUBES = 0, IW_EXTRACTOR_TRILINEAR, IW_EXTRACTOR_TETRAHEDRA, IW_EXTRACTOR_DUAL };
enum { IW_DEVICE_AUTO = 0, IW_DEVICE_CPU, IW_DEVICE_CUDA };

// How a surface is simplified. Lengths are texts: "0.2vox", "50um", "0.1%" of the diagonal of the
// volume or of the box around the mesh, or a number in its unit.
typedef struct iw_simplify_options {
  size_t struct_size;
  const char* error;         // NULL: "0.2vox" for volumes, unless one of the next four is given; "inf" beside
                             // max_distance, triangles or ratio
  const char* levels;        // errors of several meshes, ascending: "0.1vox,0.3vox,1vox"; one output for each,
                             // 256 at most
  const char* max_distance;  // a guarantee; NULL: none
  uint64_t triangles;        // stop at this number; 0: no such number
  double ratio;              // stop at this part of the full surface's triangles; 0: no such part
  int32_t quality;           // IW_QUALITY_NORMAL ...
  int32_t drop_specks;       // 1: closed components that have shrunk to a tetrahedron within the error are dropped
  uint64_t min_component;    // components of fewer triangles before simplification are dropped
  int32_t largest;           // 1: all components but the largest are dropped
  int32_t reserved;          // 0
} iw_simplify_options;

// Which surface of a volume, and what its vertices carry.
typedef struct iw_mesh_options {
  size_t struct_size;
  double iso;                           // a value: slope and intercept are accounted for
  const iw_simplify_options* simplify;  // NULL: the defaults
  int32_t inside_below;                 // 1: inside is value <= iso, else value >= iso
  int32_t open;                         // 1: the surface ends at the volume's border, else it is closed there
  int32_t smooth;                       // passes that take the staircase off a mask, 0 to 64
  int32_t normals;                      // IW_NORMALS_NONE ...
  int32_t space;                        // IW_OUTPUT_AS_VOLUME ...
  const iw_volume* values;              // a volume of the same size, whose values the vertices get; NULL: none
  int32_t extractor;                    // IW_EXTRACTOR_CUBES ...: as ExtractorKind of mesh_options.hpp
  int32_t reserved;                     // 0
} iw_mesh_options;

typedef struct iw_progress {
  size_t struct_size;
  int64_t layer, layers;  // done, and in all
  uint64_t voxels;        // read so far
  uint64_t live_triangles, final_triangles;
  uint64_t bytes;  // held by the slab and the undecided zone
} iw_progress;

// How a run computes. Nothing here changes the mesh.
typedef struct iw_run {
  size_t struct_size;
  int32_t threads;      // 0: one for each processor
  int32_t device;       // IW_DEVICE_AUTO ...
  int64_t slab;         // layers at a time; 0: chosen
  uint64_t memory;      // bytes that the process should stay below; 0: no cap
  const iw_stop* stop;  // NULL: none
  void* context;
  // Called after every slab by the thread that called. Returns 0, or another number to stop the run. NULL: none.
  int32_t (*progress)(void* context, const iw_progress* progress);
  // iw_mesh_volume only, with outputs that are files: a folder, made where it is missing, in which the state of the run
  // is saved, so that it can go on after the process has ended in any way. A run that is done leaves nothing in it. A
  // run that is stopped by an iw_stop saves its state first; else the one that was saved last is there. NULL: none.
  const char* checkpoint;
  double checkpoint_seconds;  // save after at least so long; 0: 300
  int64_t checkpoint_layers;  // save after at least so many layers; 0: by time
  // 1: go on from the state in `checkpoint`, with the same volume, options and outputs, or begin where there is none.
  // 0: an unfinished run in it is refused. The report has `resumed_at`, the layers that were done before.
  int32_t resume;
  int32_t reserved;  // 0
} iw_run;

// A piece of a mesh on its way to a sink, valid during the call only. Arrays without elements may be NULL.
typedef struct iw_piece {
  size_t struct_size;
  uint64_t vertices, triangles;
  const float* points;      // 3 for each vertex, numbered on from the last piece
  const float* normals;     // likewise, or NULL throughout
  const float* values;      // 1 for each vertex, or NULL throughout
  const uint64_t* corners;  // 3 for each triangle: any vertices handed over so far
  double offset[3];         // of all points, the same in all pieces
} iw_piece;

// A sink of pieces by callbacks, which return 0, or another number to stop the run. A run may call them from a thread
// of its own, never from two at the same time for one sink.
typedef struct iw_sink {
  size_t struct_size;
  void* context;
  int32_t (*append)(void* context, const iw_piece* piece);
  int32_t (*finish)(void* context);  // the mesh is complete; NULL: not told
} iw_sink;

// Where a mesh goes: into a file, to a sink, or, where neither is named, into memory.
typedef struct iw_output {
  size_t struct_size;
  const char* path;  // streamed, complete or absent
  const iw_sink* sink;
  iw_mesh* mesh;      // set by a run that is done, to be freed by the caller; NULL before
  int32_t compress;   // of a file: as MeshFileOptions::compress
  const char* label;  // iw_mesh_labels only: the number of the label, in decimal digits
  double iso;         // iw_mesh_isos only: as iw_mesh_options::iso
} iw_output;

// Meshes a volume. outputs: one, or one for each level, finest first. run: NULL for the defaults. The report is that of
// `isoweave mesh --report`.
iw_status iw_mesh_volume(const iw_volume* volume, const iw_mesh_options* options, const iw_run* run, iw_output* outputs,
                         size_t count, iw_result* result);

// Meshes labels of a label map in one sweep, each to its output. options: iso and inside_below do not count; a number
// or a ratio of triangles is one for each label. Sinks of different labels are called at the same time. In the report,
// `labels` has an entry for each output.
iw_status iw_mesh_labels(const iw_volume* volume, const iw_mesh_options* options, const iw_run* run, iw_output* outputs,
                         size_t count, iw_result* result);

// Meshes the surfaces of several iso-values in one sweep, each to its output: bit for bit the meshes of runs of their
// own, with `iso` from the output. options: iso does not count; a number or a ratio of triangles is one for each mesh.
// In the report, `isos` has an entry for each output.
iw_status iw_mesh_isos(const iw_volume* volume, const iw_mesh_options* options, const iw_run* run, iw_output* outputs,
                       size_t count, iw_result* result);

// Simplifies a mesh. options: one of error, levels, max_distance, triangles and ratio at least.
iw_status iw_simplify_mesh(const iw_mesh* mesh, const iw_simplify_options* options, const iw_run* run,
                           iw_output* outputs, size_t count, iw_result* result);

// The forecast of a run, from a part of the volume: triangles_extracted, triangles, vertices, peak_bytes, least_bytes
// and seconds, into the report.
iw_status iw_forecast(const iw_volume* volume, const iw_mesh_options* options, const iw_run* run, iw_result* result);

#ifdef __cplusplus
}  // extern "C"
#endif
// NOLINTEND(readability-identifier-naming,modernize-*)
#pragma GCC visibility pop
#endif
