/* The DDS partitions of a world.
 *
 * A reporter publishes in two partitions. NAME, the world's name, is for readers that know no more:
 * other machines, other users, programs of users. NAME@FOLDER names one world alone, because
 * FOLDER stands for the runtime folder that holds the name, and a folder holds a name once. Two
 * users' worlds of one name, or one user's in two runtime folders, share NAME and not this one. */
#ifndef JOLON_IPC_SEGMENT_WORLD_PARTITION_H
#define JOLON_IPC_SEGMENT_WORLD_PARTITION_H

#include "ipc/segment/world_names.h"

#include <stdbool.h>

#define WORLD_PARTITION_DIGITS 16u                     /* hexadecimal, of FOLDER */
#define WORLD_PARTITION_MAX    (SEGMENT_NAME_MAX + 17) /* with the NUL */

/* Writes the partition NAME@FOLDER of a world of this user's runtime folder, which need not exist
 * yet. FOLDER is 16 hexadecimal digits that follow from the machine's boot and the folder's device
 * and inode: each program that uses the folder gets the same, and no other folder of a machine has
 * it. Returns 0, or -1 with the reason: no runtime folder, or no /proc. Reads files; call it before
 * a process enters its sandbox. */
int world_partition_own(char own[WORLD_PARTITION_MAX], const char *world, struct error_text *error);

#endif
