/* jolon dis record: writes every datagram that comes into a capture. */
#ifndef JOLON_GATEWAY_TOOL_RECORD_H
#define JOLON_GATEWAY_TOOL_RECORD_H

/* Reads the arguments after the verb and runs it. Returns the exit code; wrong usage and refusals
 * end the process. */
int record_run(int argc, char **argv);

#endif
