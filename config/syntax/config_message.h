/* The message with which a reader of configuration refuses a file. */
#ifndef JOLON_CONFIG_SYNTAX_CONFIG_MESSAGE_H
#define JOLON_CONFIG_SYNTAX_CONFIG_MESSAGE_H

struct config_message {
    char text[1024]; /* "file:line: key = value: what is wrong; what would be right" */
};

#endif
