/* Lists of rows by cell. */
#include "collider/broad_phase/cruise_index.h"

#include "world/maths/maths.h"
#include "world/runtime/reserve.h"

#include <stdlib.h>
#include <string.h>

#define CELL_M   128.0  /* the least side of a cell */
#define SIDE_MAX 2048.0 /* cells along an edge */
#define ROW_NONE UINT32_MAX

int cruise_index_init(struct cruise_index *index, uint32_t rows, double world_m)
{
    double cell_m = maths_max(CELL_M, world_m / SIDE_MAX);
    uint32_t side = (uint32_t)(world_m / cell_m) + 1u;
    uint32_t words = (rows + 1023u) / 1024u * 16u;
    *index =
        (struct cruise_index){.words = words,
                              .side = side,
                              .cells_a_m = (float)(1.0 / cell_m),
                              .entry = reserve_take(rows, sizeof *index->entry),
                              .first = reserve_take((uint64_t)side * side, sizeof *index->first),
                              .held = calloc(words, sizeof *index->held)};
    return index->entry && index->first && index->held ? 0 : -1;
}

void cruise_index_free(struct cruise_index *index)
{
    reserve_free(index->entry);
    reserve_free(index->first);
    free(index->held);
    *index = (struct cruise_index){0};
}

static uint32_t axis_of(const struct cruise_index *index, float metres)
{
    float cell = metres * index->cells_a_m, last = (float)(index->side - 1);
    return !(cell > 0.0f) ? 0 : cell < last ? (uint32_t)cell : index->side - 1;
}

void cruise_index_add(struct cruise_index *index, uint32_t row, const struct path_box *box)
{
    struct cruise_entry *entry = &index->entry[row];
    float x_m = box->max_x - box->min_x, z_m = box->max_z - box->min_z;
    float long_m = x_m > z_m ? x_m : z_m;
    uint32_t cell = axis_of(index, box->min_z) * index->side + axis_of(index, box->min_x);
    *entry = (struct cruise_entry){box->min_x,         box->max_x, box->min_z, box->max_z,
                                   index->first[cell], 0,          cell,       0};
    if (entry->next != 0)
        index->entry[entry->next - 1].before = row + 1;
    index->first[cell] = row + 1;
    index->longest_m = long_m > index->longest_m ? long_m : index->longest_m;
    index->held[row / 64] |= (uint64_t)1 << row % 64;
    index->count++;
}

void cruise_index_remove(struct cruise_index *index, uint32_t row)
{
    const struct cruise_entry *entry = &index->entry[row];
    if (entry->next != 0)
        index->entry[entry->next - 1].before = entry->before;
    if (entry->before != 0)
        index->entry[entry->before - 1].next = entry->next;
    else
        index->first[entry->cell] = entry->next;
    index->held[row / 64] &= ~((uint64_t)1 << row % 64);
    index->count--;
}

void cruise_index_clear(struct cruise_index *index)
{
    for (uint32_t w = 0; w < index->words && index->count > 0; w++) {
        for (uint64_t bits = index->held[w]; bits != 0; bits &= bits - 1)
            cruise_index_remove(index, w * 64 + (uint32_t)__builtin_ctzll(bits));
    }
}

static bool meets(const struct cruise_entry *entry, const struct path_box *box)
{
    return entry->min_x <= box->max_x && box->min_x <= entry->max_x && entry->min_z <= box->max_z &&
           box->min_z <= entry->max_z;
}

static void add_found(struct pair_list *found, uint32_t row, uint32_t other)
{
    if (row == ROW_NONE)
        pair_list_add(found, other, 0);
    else if (row != other)
        pair_list_add(found, row < other ? row : other, row < other ? other : row);
}

static void find(const struct cruise_index *index, uint32_t row, const struct path_box *box,
                 struct pair_list *found)
{
    uint32_t x0 = axis_of(index, box->min_x - index->longest_m), x1 = axis_of(index, box->max_x);
    uint32_t z0 = axis_of(index, box->min_z - index->longest_m), z1 = axis_of(index, box->max_z);
    if (index->count == 0)
        return;
    for (uint32_t z = z0; z <= z1; z++) {
        for (uint32_t x = x0; x <= x1; x++) {
            for (uint32_t at = index->first[z * index->side + x]; at != 0;
                 at = index->entry[at - 1].next)
                if (meets(&index->entry[at - 1], box))
                    add_found(found, row, at - 1);
        }
    }
}

void cruise_index_pairs(const struct cruise_index *index, uint32_t row, const struct path_box *box,
                        struct pair_list *pairs)
{
    find(index, row, box, pairs);
}

void cruise_index_query(const struct cruise_index *index, const struct path_box *box,
                        struct pair_list *found)
{
    find(index, ROW_NONE, box, found);
}
