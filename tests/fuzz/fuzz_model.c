/* Models: an OBJ file and, after a line "%%", the file of materials k.mtl beside it. Without that
 * line there is only box.mtl. Tests the reader, the tables and the hulls. */
#include "tests/fuzz/support.h"

#include "config/mesh/models.h"
#include "ipc/process/log.h"
#include "world/making/scenario.h"
#include "world/runtime/check.h"

#include <string.h>

#define SEPARATOR "\n%%\n"

static void put(const uint8_t *data, size_t size)
{
    const uint8_t *at = memmem(data, size, SEPARATOR, strlen(SEPARATOR));
    size_t first = at ? (size_t)(at - data) + 1 : size;
    support_put("models/k.obj", data, first);
    if (at) {
        size_t second = first + strlen(SEPARATOR) - 1;
        support_put("models/k.mtl", data + second, size - second);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static struct models models;
    struct scenario scenario = {0};
    struct error_text error;
    XXH3_state_t *hash = XXH3_createState();
    CHECK(hash && XXH3_64bits_reset(hash) == XXH_OK);
    put(data, size);
    models_open(&models, &scenario, support_data_dir(), hash);
    int index = models_find(&models, "k", &error);
    if (index >= 0)
        support_check_model(&scenario, (uint16_t)index, &models.hulls[index]);
    else
        support_check_message(&error);
    models_close(&models);
    XXH3_freeState(hash);
    scenario_free(&scenario);
    return 0;
}
