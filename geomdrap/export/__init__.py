"""Result files: one module per format, each with ``write(result, path)``; `outputs` lists them."""
