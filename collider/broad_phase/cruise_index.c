/* Lists of rows by cell. */
#include "collider/broad_phase/cruise_index.h"

#include "world/maths/maths.h"
#include "world/runtime/prefault.h"
#include "world/runtime/reserve.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define SHORT_M  32.0f  /* the longest side of a short box */
#define CELL_M   64.0   /* the least side of a cell of short boxes, in a crowd */
#define LONG_M   128.0  /* the least side of a cell of long ones, and of any in a small world */
#define SIDE_MAX 2048.0 /* cells along an edge */
#define ROW_NONE UINT32_MAX

static int layer_init(struct cruise_layer *layer, double least_m, double world_m)
{
    double cell_m = maths_max(least_m, world_m / SIDE_MAX);
    uint32_t side = (uint32_t)(world_m / cell_m) + 1u;
    *layer = (struct cruise_layer){.first = reserve_take((uint64_t)side * side, sizeof(uint32_t)),
                                   .side = side,
                                   .cells_a_m = (float)(1.0 / cell_m)};
    return layer->first ? 0 : -1;
}

int cruise_index_init(struct cruise_index *index, uint32_t rows, double world_m)
{
    uint32_t words = (rows + 1023u) / 1024u * 16u;
    *index = (struct cruise_index){.words = words,
                                   .entry = reserve_take(rows, sizeof *index->entry),
                                   .held = calloc(words, sizeof *index->held)};
    double short_m = maths_clamp(world_m / sqrt((double)rows), CELL_M, LONG_M);
    bool taken = layer_init(&index->layer[0], short_m, world_m) == 0 &&
                 layer_init(&index->layer[1], LONG_M, world_m) == 0;
    return taken && index->entry && index->held ? 0 : -1;
}

void cruise_index_free(struct cruise_index *index)
{
    for (int l = 0; l < CRUISE_LAYERS; l++)
        reserve_free(index->layer[l].first);
    reserve_free(index->entry);
    free(index->held);
    *index = (struct cruise_index){0};
}

void cruise_index_touch(const struct cruise_index *index, uint32_t rows)
{
    for (int l = 0; l < CRUISE_LAYERS; l++) {
        const struct cruise_layer *layer = &index->layer[l];
        prefault_own(layer->first, (size_t)layer->side * layer->side * sizeof *layer->first);
    }
    prefault_own(index->entry, rows * sizeof *index->entry);
}

static uint32_t axis_of(const struct cruise_layer *layer, float metres)
{
    float cell = metres * layer->cells_a_m, last = (float)(layer->side - 1);
    return !(cell > 0.0f) ? 0 : cell < last ? (uint32_t)cell : layer->side - 1;
}

static float longest_of(const struct path_box *box)
{
    float x_m = box->max_x - box->min_x, z_m = box->max_z - box->min_z;
    return x_m > z_m ? x_m : z_m;
}

static uint32_t layer_of(const struct path_box *box)
{
    return longest_of(box) > SHORT_M;
}

static uint32_t *first_of(const struct cruise_layer *layer, const struct path_box *box)
{
    return &layer->first[axis_of(layer, box->min_z) * layer->side + axis_of(layer, box->min_x)];
}

void cruise_index_add(struct cruise_index *index, uint32_t row, const struct path_box *box)
{
    struct cruise_entry *entry = &index->entry[row];
    struct cruise_layer *layer = &index->layer[layer_of(box)];
    uint32_t *first = first_of(layer, box);
    float long_m = longest_of(box);
    *entry = (struct cruise_entry){*box, *first, 0};
    if (entry->next != 0)
        index->entry[entry->next - 1].before = row + 1;
    *first = row + 1;
    layer->longest_m = long_m > layer->longest_m ? long_m : layer->longest_m;
    layer->count++;
    index->held[row / 64] |= (uint64_t)1 << row % 64;
    index->count++;
}

void cruise_index_remove(struct cruise_index *index, uint32_t row)
{
    const struct cruise_entry *entry = &index->entry[row];
    struct cruise_layer *layer = &index->layer[layer_of(&entry->box)];
    if (entry->next != 0)
        index->entry[entry->next - 1].before = entry->before;
    if (entry->before != 0)
        index->entry[entry->before - 1].next = entry->next;
    else
        *first_of(layer, &entry->box) = entry->next;
    layer->count--;
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
    const struct path_box *its = &entry->box;
    return its->min_x <= box->max_x && box->min_x <= its->max_x && its->min_z <= box->max_z &&
           box->min_z <= its->max_z;
}

static void add_found(struct pair_list *found, uint32_t row, uint32_t other)
{
    if (row == ROW_NONE)
        pair_list_add(found, other, 0);
    else if (row != other)
        pair_list_add(found, row < other ? row : other, row < other ? other : row);
}

static void find_in(const struct cruise_index *index, const struct cruise_layer *layer,
                    uint32_t row, const struct path_box *box, struct pair_list *found)
{
    uint32_t x0 = axis_of(layer, box->min_x - layer->longest_m), x1 = axis_of(layer, box->max_x);
    uint32_t z0 = axis_of(layer, box->min_z - layer->longest_m), z1 = axis_of(layer, box->max_z);
    for (uint32_t z = z0; z <= z1; z++) {
        for (uint32_t x = x0; x <= x1; x++) {
            for (uint32_t at = layer->first[z * layer->side + x]; at != 0;
                 at = index->entry[at - 1].next)
                if (meets(&index->entry[at - 1], box))
                    add_found(found, row, at - 1);
        }
    }
}

static void find(const struct cruise_index *index, uint32_t row, const struct path_box *box,
                 struct pair_list *found)
{
    for (int l = 0; l < CRUISE_LAYERS; l++) {
        if (index->layer[l].count > 0)
            find_in(index, &index->layer[l], row, box, found);
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
