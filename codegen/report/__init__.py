"""What people read: tables and figures made of finished results; nothing is computed here."""
