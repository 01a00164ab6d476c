/* The datagrams of this process's DDS: its sendmsg() and recvmsg() stand in front of the C
 * library's, for the shared library of Cyclone DDS. What comes passes ipc/topics/rtps_filter.h.
 * What goes out is what Cyclone DDS sends, but for announcements to participants that have left: it
 * would announce its own participants to them for ever. */
#ifndef JOLON_IPC_TOPICS_DDS_DATAGRAMS_H
#define JOLON_IPC_TOPICS_DDS_DATAGRAMS_H

#include <stdbool.h>

/* To be called before the domain is made. forget: nothing is announced to an address of one
 * participant, other than a group of them, unless one announces itself from there; false where
 * others are looked for at given addresses. */
void dds_datagrams_begin(bool forget);

#endif
