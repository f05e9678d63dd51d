"""What all tests share: this folder is on the path, so that ``made_parts`` can be imported."""
