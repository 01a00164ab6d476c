/* The datagrams of this process's DDS. Its sendmsg() and recvmsg() replace the C library's for the
 * shared library of Cyclone DDS. Received datagrams pass ipc/topics/rtps_filter.h. Sent datagrams
 * pass unchanged, except announcements to participants that have left: Cyclone DDS would send those
 * for ever. */
#ifndef JOLON_IPC_TOPICS_DDS_DATAGRAMS_H
#define JOLON_IPC_TOPICS_DDS_DATAGRAMS_H

#include <stdbool.h>

/* To be called before the domain is made. With forget set, announcements to a unicast address are
 * sent only while a participant announces itself from there. It must be false where the
 * configuration names the addresses of peers. */
void dds_datagrams_begin(bool forget);

#endif
