/* jolon dis play: sends the datagrams of a capture again, with their timing or faster. */
#ifndef JOLON_GATEWAY_TOOL_PLAY_H
#define JOLON_GATEWAY_TOOL_PLAY_H

/* Reads the arguments after the verb and runs it. Returns the exit code; wrong usage and refusals
 * end the process. */
int play_run(int argc, char **argv);

#endif
