/* MPS II and III (Winn and Strong 1989, Cheeseman 1990, as cited by Osborne 1991, p. 6): two
 * platforms within a certain range of each other on the map are both destroyed. Heights and trees
 * are not tested, and only the positions at the frame's end. */
#include "collider/method/method.h"

#include "world/entity/kind.h"
#include "world/params.h"
#include "world/runtime/work_done.h"
#include "world/world.h"

/* A platform's place on the map. */
struct spot {
    double x, z;
    uint32_t row;
};

static uint32_t list_platforms(const struct method_input *input, struct spot *spot)
{
    const struct entities *e = input->entities;
    uint32_t count = 0;
    for (uint32_t i = 0; i < input->rows; i++) {
        if (pair_filter_there(input, i) &&
            input->world->kinds[e->row[i].kind].domain < DOMAIN_MUNITION)
            spot[count++] = (struct spot){e->row[i].x, e->row[i].z, i};
    }
    return count;
}

void method_mps_pairs(const struct method_input *input, struct method_workspace *workspace,
                      struct pair_list *pairs)
{
    struct spot *spot = method_block(workspace, 0, input->rows, sizeof *spot);
    double near = input->world->params->collision.mps_near_m;
    uint32_t count = list_platforms(input, spot);
    for (uint32_t a = 0; a < count; a++) {
        work_done();
        for (uint32_t b = a + 1; b < count; b++) {
            double dx = spot[b].x - spot[a].x, dz = spot[b].z - spot[a].z;
            if (dx * dx + dz * dz <= near * near && !pair_excluded(input, spot[a].row, spot[b].row))
                pair_list_add(pairs, spot[a].row, spot[b].row);
        }
    }
}
