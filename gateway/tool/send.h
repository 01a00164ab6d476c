/* jolon dis send: sends one PDU that is built from words, once or again and again, or writes it
 * into a capture. */
#ifndef JOLON_GATEWAY_TOOL_SEND_H
#define JOLON_GATEWAY_TOOL_SEND_H

/* Reads the arguments after the verb and runs it. Returns the exit code; wrong usage and refusals
 * end the process. */
int send_run(int argc, char **argv);

#endif
