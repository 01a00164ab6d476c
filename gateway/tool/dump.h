/* jolon dis dump: shows the PDUs of a capture, or of the network as they come, as text or as JSON
 * lines. */
#ifndef JOLON_GATEWAY_TOOL_DUMP_H
#define JOLON_GATEWAY_TOOL_DUMP_H

/* Reads the arguments after the verb and runs it. Returns the exit code; wrong usage and refusals
 * end the process. */
int dump_run(int argc, char **argv);

#endif
