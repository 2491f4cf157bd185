"""Reports of the dispatch centre: incidents (EIDO or plain JSON) and alerts (CAP). Pure."""
