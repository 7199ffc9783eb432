"""Fixed layouts, the walked camera's path, camera shake."""
