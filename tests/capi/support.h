// Parts that the tests of the C interface share: a volume, a result, and numbers read from reports.
#ifndef ISOWEAVE_TESTS_SUPPORT_H
#define ISOWEAVE_TESTS_SUPPORT_H

#include <isoweave/isoweave.h>
#include <stdio.h>

enum { SIDE = 36, SAMPLES = SIDE * SIDE * SIDE };

extern int faults;
extern iw_result result;

#define EXPECT(condition)                                             \
  do {                                                                \
    if (!(condition)) {                                               \
      printf("%s:%d: expected %s\n", __FILE__, __LINE__, #condition); \
      ++faults;                                                       \
    }                                                                 \
  } while (0)

// Whether the status of a call is the expected one. It prints the message where it is not.
int is(iw_status found, iw_status expected);

// The text after "KEY": in JSON, up to the next comma or bracket, without quotes; and the number there.
void text_in(const char* json, const char* key, char* out, size_t room);
double number_in(const char* json, const char* key);
void keep_digest(char digest[17]);  // of the result's report

int exists(const char* path);

// A ball with a dent and a small one beside it: not the same along any two axes.
void fill(float* samples);
iw_volume_info info_of_samples(void);
iw_volume* volume_of(const float* samples);

iw_simplify_options within(const char* error);

void test_isos(const float* samples);
void test_checkpoints(const float* samples);

#endif
