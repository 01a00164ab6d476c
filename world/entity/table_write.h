/* Writes single fields of rows and notes which rows were written, so that these alone are copied
 * and hashed again (world/checksum.h).
 *
 * Each function writes its field and sets one bit. Not thread-safe: one writer a word of bits. */
#ifndef JOLON_WORLD_ENTITY_TABLE_WRITE_H
#define JOLON_WORLD_ENTITY_TABLE_WRITE_H

#include "world/entity/entity.h"

#define CHECKSUM_ROWS   1024u /* of a block; docs/decisions/019 has the cost of others */
#define CHECKSUM_BLOCKS (CAPACITY_MAX / CHECKSUM_ROWS)

/* Words of a bit for each row of a block. */
#define ROW_BLOCK_WORDS (CHECKSUM_ROWS / 64u)
#define ROW_BLOCK_BYTES (ROW_BLOCK_WORDS * sizeof(uint64_t))

struct table_writer {
    const struct entities *entities;
    uint64_t *resting; /* a bit for each row, which is cleared when the row is written; or NULL */
    uint64_t *written; /* a bit for each row, which is set when the row is written */
};

/* Notes that a row is written. Who writes fields itself, as that of a new row, says so by this. */
static inline void table_note(const struct table_writer *writer, uint32_t row)
{
    if (writer->resting)
        writer->resting[row / 64] &= ~((uint64_t)1 << row % 64);
    writer->written[row / 64] |= (uint64_t)1 << row % 64;
}

/* table_set_x(writer, row, x) and so on: one for each field. */
#define X(type, name)                                                                              \
    static inline void table_set_##name(const struct table_writer *writer, uint32_t row,           \
                                        type value)                                                \
    {                                                                                              \
        table_note(writer, row);                                                                   \
        writer->entities->row[row].name = value;                                                   \
    }
ENTITY_FIELDS(X)
#undef X

static inline void table_set_position(const struct table_writer *writer, uint32_t row,
                                      struct vec3 position)
{
    table_set_x(writer, row, position.x);
    table_set_y(writer, row, position.y);
    table_set_z(writer, row, position.z);
}

static inline void table_set_velocity(const struct table_writer *writer, uint32_t row,
                                      struct vec3 velocity)
{
    table_set_vx(writer, row, velocity.x);
    table_set_vy(writer, row, velocity.y);
    table_set_vz(writer, row, velocity.z);
}

static inline void table_set_spin(const struct table_writer *writer, uint32_t row,
                                  struct vec3 spin_rps)
{
    table_set_spin_x(writer, row, spin_rps.x);
    table_set_spin_y(writer, row, spin_rps.y);
    table_set_spin_z(writer, row, spin_rps.z);
}

/* Sets the target that the row attacks. */
static inline void table_set_target(const struct table_writer *writer, uint32_t row, uint32_t slot,
                                    uint32_t id)
{
    table_set_target_slot(writer, row, slot);
    table_set_target_id(writer, row, id);
}

/* Sets the entity that has fired at the row. */
static inline void table_set_threat(const struct table_writer *writer, uint32_t row, uint32_t slot,
                                    uint32_t id)
{
    table_set_threat_slot(writer, row, slot);
    table_set_threat_id(writer, row, id);
}

/* Sets the row to zero in every field: a free slot. */
static inline void table_clear_row(const struct table_writer *writer, uint32_t row)
{
    table_note(writer, row);
    entities_clear(writer->entities, row);
}

/* Makes the row what it is in another table. */
static inline void table_copy_row(const struct table_writer *writer, const struct entities *from,
                                  uint32_t row)
{
    table_note(writer, row);
    entities_copy(writer->entities, from, row, 1);
}

/* Sets rows first .. end - 1 to zero where they hold something, so that a reference to one of them
 * is void. For rows beyond those in use: they are in no checksum, so nothing is noted. Nothing to
 * do if end <= first. */
static inline void table_clear_unused(const struct entities *entities, uint32_t first, uint32_t end)
{
    for (uint32_t row = first; row < end; row++) {
        if (entities->row[row].id != 0 || entities->row[row].state != ENTITY_FREE)
            entities_clear(entities, row);
    }
}

#endif
