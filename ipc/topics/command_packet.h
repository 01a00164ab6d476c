/* The packets of a world's command socket: one for each command, one for each reply.
 *
 * The socket is local, so packets hold the IDL's types as they lie in memory. Both ends must be of
 * one build of the interface, which the version and the packet's size show. */
#ifndef JOLON_IPC_TOPICS_COMMAND_PACKET_H
#define JOLON_IPC_TOPICS_COMMAND_PACKET_H

#include "status.h"

#include <stdint.h>

/* In the runtime folder the socket is called NAME.commands. */
#define COMMAND_SOCKET_SUFFIX "commands"

#define COMMAND_PACKET_MAGIC   0x444d434au /* "JCMD" */
#define COMMAND_PACKET_VERSION 1u

struct command_packet {
    uint32_t magic, version;
    jolon_Command command;
};

struct reply_packet {
    uint32_t magic, version;
    jolon_CommandReply reply;
};

#endif
