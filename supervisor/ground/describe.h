/* The verbs info and check. */
#ifndef JOLON_SUPERVISOR_GROUND_DESCRIBE_H
#define JOLON_SUPERVISOR_GROUND_DESCRIBE_H

int describe_info(int argc, char **argv);
int describe_check(int argc, char **argv);

#endif
