/* Each record is compared with those after it, up to the column of its east edge. */
#include "collider/broad_phase/record_overlaps.h"

static void set_near(_Atomic uint8_t *near, const struct bin_record *record)
{
    atomic_store_explicit(&near[record->tag & BIN_ROW], 1, memory_order_relaxed);
}

static bool meets_fixed(const struct static_boxes *fixed_boxes, uint32_t strip,
                        const struct bin_record *one)
{
    const struct bin_record *object = static_boxes_from(fixed_boxes, strip, one->min_x);
    for (; object->min_x <= one->max_x; object++) {
        if (bin_meet(one, object))
            return true;
    }
    return false;
}

void record_overlaps_find(const struct query_index *index, const struct static_boxes *fixed_boxes,
                          uint32_t strip, _Atomic uint8_t *near)
{
    uint32_t count;
    const struct bin_record *first = query_index_strip(index, strip, &count);
    for (uint32_t i = 0; i < count; i++) {
        const struct bin_record *one = &first[i];
        const struct bin_record *end = query_index_end(index, strip, one->max_x);
        bool met = one->tag & BIN_LONG || meets_fixed(fixed_boxes, strip, one);
        for (const struct bin_record *other = one + 1; other < end; other++) {
            if (!bin_meet(one, other))
                continue;
            met = true;
            set_near(near, other);
        }
        if (met)
            set_near(near, one);
    }
}
