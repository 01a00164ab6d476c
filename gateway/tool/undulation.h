/* jolon dis undulation: the height of the sea level above the ellipsoid at a place, for a
 * scenario's gateway.undulation_m. */
#ifndef JOLON_GATEWAY_TOOL_UNDULATION_H
#define JOLON_GATEWAY_TOOL_UNDULATION_H

/* Reads the arguments after the verb and runs it. Returns the exit code; wrong usage and refusals
 * end the process. */
int undulation_run(int argc, char **argv);

#endif
