/* Random earthworks for tests. */
#include "tests/support/works.h"

#include "tests/support/fixture.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

void works_scatter(struct earthwork *works, uint32_t count, double low, double high, double edge_m,
                   uint64_t *random)
{
    for (uint32_t i = 0; i < count; i++) {
        struct earthwork *work = &works[i];
        *work = (struct earthwork){.x = fixture_uniform(random, low, high),
                                   .z = fixture_uniform(random, low, high),
                                   .half_length = fixture_uniform(random, 1.0, 100.0),
                                   .half_width = fixture_uniform(random, 1.0, 40.0),
                                   .height_m = fixture_uniform(random, -3.0, 3.0),
                                   .grip = fixture_uniform(random, 0.1, 1.0),
                                   .shape = i % EARTHWORK_SHAPE_COUNT};
        maths_sincos(fixture_uniform(random, 0.0, TWO_PI), &work->sine, &work->cosine);
        work->back_m = work->front_m = work->side_m = fixture_uniform(random, edge_m, 2.5 * edge_m);
        if (i % 4 == 0)
            work->wave_m = fixture_uniform(random, 5.0 * edge_m, 12.0 * edge_m);
    }
}

struct earthworks works_index(const struct earthwork *works, uint32_t count)
{
    uint32_t *index, words;
    assert_int_equal(earthwork_index_build(works, count, &GRIDSQUARES_DEFAULT, &index, &words), 0);
    return (struct earthworks){works, index, count, GRIDSQUARES_DEFAULT};
}

void works_free(struct earthworks *works)
{
    free((void *)(uintptr_t)works->index);
    *works = (struct earthworks){.works = NULL};
}
