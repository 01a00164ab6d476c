/* Kind files, in addition to those of support.c. */
#include "tests/fuzz/support.h"
#include "world/making/scenario.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct error_text error;
    struct scenario scenario;
    support_put("kinds/k.cfg", data, size);
    if (loader_scenario(&scenario, support_data_dir(), support_file("", 0), NULL, 0, &error) != 0) {
        support_check_message(&error);
        return 0;
    }
    support_check_scenario(&scenario);
    scenario_free(&scenario);
    return 0;
}
