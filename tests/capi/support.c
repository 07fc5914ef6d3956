#include "support.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

int faults = 0;
iw_result result = {sizeof(iw_result), NULL, NULL};

int is(iw_status found, iw_status expected) {
  if (found != expected) printf("status %d: %s\n", found, result.message == NULL ? "" : result.message);
  return found == expected && (found == IW_DONE) == (result.message == NULL);
}

void text_in(const char* json, const char* key, char* out, size_t room) {
  char quoted[64];
  snprintf(quoted, sizeof quoted, "\"%s\":", key);
  out[0] = 0;
  const char* at = json == NULL ? NULL : strstr(json, quoted);
  if (at == NULL) return;
  at += strlen(quoted);
  while (*at == ' ' || *at == '"') ++at;
  const size_t length = strcspn(at, "\",}]");
  snprintf(out, room, "%.*s", (int)(length < room ? length : room - 1), at);
}

double number_in(const char* json, const char* key) {
  char text[64];
  text_in(json, key, text, sizeof text);
  return text[0] == 0 ? (double)NAN : strtod(text, NULL);
}

void keep_digest(char digest[17]) { text_in(result.report, "digest", digest, 17); }

int exists(const char* path) {
  FILE* file = fopen(path, "rb");
  if (file != NULL) fclose(file);
  return file != NULL;
}

void fill(float* samples) {
  for (int k = 0; k < SIDE; ++k)
    for (int j = 0; j < SIDE; ++j)
      for (int i = 0; i < SIDE; ++i) {
        const double x = i - 15.2, y = j - 14.1, z = k - 17.7;
        const double ball =
            11.3 - sqrt(x * x + 1.1 * y * y + 0.9 * z * z) + 0.8 * sin(0.7 * x) * cos(0.5 * y + 0.3 * z);
        const double small = 3.1 - sqrt((i - 31) * (i - 31) + (j - 30) * (j - 30) + (k - 29) * (k - 29));
        samples[(k * SIDE + j) * SIDE + i] = (float)(ball > small ? ball : small);
      }
}

iw_volume_info info_of_samples(void) {
  iw_volume_info info = {.struct_size = sizeof info};
  info.dims[0] = info.dims[1] = info.dims[2] = SIDE;
  info.type = IW_FLOAT32;
  info.spacing[0] = 0.5;
  info.spacing[1] = 0.75;
  info.spacing[2] = 1.25;
  info.origin[0] = 3;
  return info;
}

iw_volume* volume_of(const float* samples) {
  const iw_volume_info info = info_of_samples();
  iw_volume* volume = NULL;
  EXPECT(is(iw_volume_in_memory(&info, samples, SAMPLES * sizeof(float), &volume, &result), IW_DONE));
  return volume;
}

iw_simplify_options within(const char* error) {
  iw_simplify_options simplify = {.struct_size = sizeof simplify};
  simplify.error = error;
  return simplify;
}
