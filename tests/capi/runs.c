// Runs with several iso-values, and runs that are stopped and go on.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support.h"

// Several iso-values from one sweep, each beside the run of its own.
void test_isos(const float* samples) {
  iw_volume* volume = volume_of(samples);
  const iw_simplify_options simplify = within("0.3vox");
  iw_mesh_options options = {.struct_size = sizeof options};
  options.simplify = &simplify;
  options.extractor = IW_EXTRACTOR_DUAL;
  iw_output outputs[3] = {{.struct_size = sizeof outputs[0]}, {.struct_size = sizeof outputs[0]}};
  outputs[2].struct_size = sizeof outputs[0];
  outputs[0].iso = 2.5;
  outputs[1].iso = -1;
  outputs[1].path = "c_iso.ply";
  EXPECT(is(iw_mesh_isos(volume, &options, NULL, outputs, 3, &result), IW_DONE));
  char digests[3][17];
  const char* entry = strstr(result.report, "\"isos\"");
  EXPECT(entry != NULL && strstr(result.report, "\"extractor\":\"dual\"") != NULL);
  for (int n = 0; entry != NULL && n < 3; ++n) {
    entry = strstr(entry, "{\"iso\":");
    EXPECT(number_in(entry, "iso") == outputs[n].iso);
    text_in(entry, "digest", digests[n], sizeof digests[n]);
    ++entry;
  }
  for (int n = 0; n < 3; ++n) {
    char wanted[17], found[17];
    options.iso = outputs[n].iso;
    iw_output alone = {.struct_size = sizeof alone};
    EXPECT(is(iw_mesh_volume(volume, &options, NULL, &alone, 1, &result), IW_DONE));
    keep_digest(wanted);
    iw_free_mesh(alone.mesh);
    EXPECT((outputs[n].mesh == NULL) == (n == 1));
    if (n == 1) EXPECT(is(iw_read_mesh("c_iso.ply", 0, &outputs[n].mesh, &result), IW_DONE));
    EXPECT(is(iw_check_mesh(outputs[n].mesh, 0, 0, &result), IW_DONE));
    keep_digest(found);
    EXPECT(strcmp(found, wanted) == 0 && strcmp(digests[n], wanted) == 0);
    iw_free_mesh(outputs[n].mesh);
    outputs[n].mesh = NULL;
  }
  outputs[0].iso = 0;  // as the third
  EXPECT(is(iw_mesh_isos(volume, &options, NULL, outputs, 3, &result), IW_BAD_ARGUMENT));
  EXPECT(is(iw_mesh_isos(volume, &options, NULL, outputs, 0, &result), IW_BAD_ARGUMENT));
  iw_simplify_options largest = {.struct_size = sizeof largest};
  largest.largest = 1;
  options.simplify = &largest;
  EXPECT(is(iw_mesh_isos(volume, &options, NULL, outputs + 1, 2, &result), IW_BAD_ARGUMENT));
  EXPECT(strstr(result.message, "largest") != NULL && outputs[2].mesh == NULL);
  iw_free_volume(volume);
}

static int32_t stop_at_third(void* context, const iw_progress* progress) {
  (void)progress;
  static int calls = 0;
  if (++calls == 3) iw_stop_set(context);
  return 0;
}

// A run of two levels that is stopped goes on from its state, and leaves nothing but its meshes.
void test_checkpoints(const float* samples) {
  iw_volume* volume = volume_of(samples);
  iw_simplify_options levels = {.struct_size = sizeof levels};
  levels.levels = "0.05vox,0.4vox";
  iw_mesh_options options = {.struct_size = sizeof options};
  options.simplify = &levels;
  iw_output outputs[2] = {{.struct_size = sizeof outputs[0]}, {.struct_size = sizeof outputs[0]}};
  char wanted[2][17], found[17];
  EXPECT(is(iw_mesh_volume(volume, &options, NULL, outputs, 2, &result), IW_DONE));
  for (int n = 0; n < 2; ++n) {
    EXPECT(is(iw_check_mesh(outputs[n].mesh, 0, 0, &result), IW_DONE));
    keep_digest(wanted[n]);
    iw_free_mesh(outputs[n].mesh);
    outputs[n].mesh = NULL;
  }

  EXPECT(system("rm -rf c_run") == 0);  // what a test that failed left
  iw_stop* stop = iw_stop_new();
  iw_run run = {.struct_size = sizeof run};
  run.slab = 4;
  run.checkpoint = "c_run";
  EXPECT(is(iw_mesh_volume(volume, &options, &run, outputs, 2, &result), IW_BAD_ARGUMENT));  // no files
  EXPECT(strstr(result.message, "files") != NULL && !exists("c_run"));
  const char* const paths[2] = {"c_saved0.ply", "c_saved1.ply"};
  for (int n = 0; n < 2; ++n) {
    outputs[n].path = paths[n];
    remove(paths[n]);
  }
  run.checkpoint_seconds = (double)NAN;
  EXPECT(is(iw_mesh_volume(volume, &options, &run, outputs, 2, &result), IW_BAD_ARGUMENT));
  run.checkpoint_seconds = 0;
  run.resume = 1;  // begins where there is nothing to go on from
  run.context = stop;
  run.stop = stop;
  run.progress = stop_at_third;
  EXPECT(is(iw_mesh_volume(volume, &options, &run, outputs, 2, &result), IW_STOPPED));
  EXPECT(exists("c_run/state-0") && exists("c_run/lod0/mesh.part") && !exists(paths[0]) && !exists(paths[1]));

  run.stop = NULL;
  run.progress = NULL;
  run.resume = 0;
  EXPECT(is(iw_mesh_volume(volume, &options, &run, outputs, 2, &result), IW_CANNOT_WRITE));  // it would be lost
  run.resume = 1;
  EXPECT(is(iw_mesh_volume(volume, &options, &run, outputs + 1, 1, &result), IW_BAD_INPUT));
  options.iso = 1;
  EXPECT(is(iw_mesh_volume(volume, &options, &run, outputs, 2, &result), IW_BAD_INPUT));
  options.iso = 0;
  EXPECT(is(iw_forecast(volume, &options, &run, &result), IW_DONE));
  EXPECT(is(iw_mesh_labels(volume, &options, &run, outputs, 2, &result), IW_BAD_ARGUMENT));
  EXPECT(is(iw_mesh_volume(volume, &options, &run, outputs, 2, &result), IW_DONE));
  EXPECT(number_in(result.report, "resumed_at") == 12);
  for (int n = 0; n < 2; ++n) {
    iw_mesh* mesh = NULL;
    EXPECT(is(iw_read_mesh(paths[n], 0, &mesh, &result), IW_DONE));
    EXPECT(is(iw_check_mesh(mesh, 0, 0, &result), IW_DONE));
    keep_digest(found);
    EXPECT(strcmp(found, wanted[n]) == 0);
    iw_free_mesh(mesh);
  }
  EXPECT(remove("c_run") == 0);  // empty
  iw_stop_free(stop);
  iw_free_volume(volume);
}
