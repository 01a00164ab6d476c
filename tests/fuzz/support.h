/* Shared by the fuzz harnesses: a data folder with a few kinds and one model, because reading the
 * shipped models takes longer than a test, and the rules for refusals. A harness fails through
 * CHECK or a sanitizer. */
#ifndef JOLON_TESTS_FUZZ_SUPPORT_H
#define JOLON_TESTS_FUZZ_SUPPORT_H

#include "config/mesh/hulls.h"
#include "config/loader.h"
#include "ipc/segment/segment.h"

#include <stddef.h>
#include <stdint.h>

struct scenario;

/* Called by libFuzzer. Every harness defines it. */
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* Returns the data folder for loader_scenario(), below TMPDIR. Its kinds tank, jet, ship, shell and
 * tree share the model box. Made at the first call, removed at exit. */
const char *support_data_dir(void);

/* Writes a whole file of that folder. name: for example "models/k.obj". */
void support_put(const char *name, const void *bytes, size_t size);

/* Writes the path of such a file as a terminated string. */
void support_path(char *path, size_t bytes, const char *name);

/* Makes a small world in private memory at frame 0: three blue tanks and a red jet on level ground.
 */
void support_world(struct view *view);

/* Makes the world of a scenario in private memory at frame 0. path: of the scenario's file. */
void support_world_of(struct view *view, const char *path);

/* Returns the path of a file in memory that holds these bytes. The next call changes them. */
const char *support_file(const void *bytes, size_t size);

/* Checks that a refusal is one line of printable text. */
void support_check_line(const struct error_text *error);

/* Checks a refusal of a text that libconfig has read. libconfig must never try to read another
 * file. */
void support_check_message(const struct error_text *error);

/* Checks that every number of an accepted scenario is finite and within its table: references are
 * valid, counts fit, and hulls contain their models. */
void support_check_scenario(const struct scenario *scenario);

/* Does the same for a scenario that is one model and its hulls. */
void support_check_model(struct scenario *scenario, uint16_t model, const struct hulls *hulls);

#endif
