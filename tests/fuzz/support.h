/* What the fuzz harnesses share: a data folder of a few kinds and one shape, because reading the
 * shipped ones takes longer than all the rest, and what every refusal must be. A harness ends by
 * CHECK or a sanitizer, never with a verdict of its own. */
#ifndef JOLON_TESTS_FUZZ_SUPPORT_H
#define JOLON_TESTS_FUZZ_SUPPORT_H

#include "config/mesh/hulls.h"
#include "config/loader.h"
#include "ipc/segment/segment.h"

#include <stddef.h>
#include <stdint.h>

struct scenario;

/* libFuzzer's; every harness defines it. */
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* The folder, for loader_scenario(): kinds tank, jet, ship, shell, tree, each of the model box,
 * below TMPDIR. Made at the first call, removed at exit. */
const char *support_data_dir(void);

/* Writes a whole file of that folder: "models/k.obj". */
void support_put(const char *name, const void *bytes, size_t size);

/* Its path, as a terminated text. */
void support_path(char *path, size_t bytes, const char *name);

/* A small world in private memory at frame 0: three blue tanks and a red jet on level ground. */
void support_world(struct view *view);

/* The path of a file that holds these bytes, in memory; another call changes them. */
const char *support_file(const void *bytes, size_t size);

/* A refusal is one line of printable text. */
void support_check_line(const struct error_text *error);

/* The same of what libconfig reads; and it never tries to read another file. */
void support_check_message(const struct error_text *error);

/* Every number of an accepted scenario is finite and within its table: references lead somewhere,
 * counts fit, hulls hold their models. */
void support_check_scenario(const struct scenario *scenario);

/* The same of a scenario that is one model and its hulls. */
void support_check_model(struct scenario *scenario, uint16_t model, const struct hulls *hulls);

#endif
