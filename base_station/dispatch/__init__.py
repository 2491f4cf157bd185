"""In from dispatch: incidents (EIDO or plain JSON) and alerts (CAP) of other systems.  Pure."""
