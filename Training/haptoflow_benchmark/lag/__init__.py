"""How late the vibration follows the stylus."""
