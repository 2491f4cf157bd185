"""Descriptions of fields about people, their crews and photos."""

from __future__ import annotations

from collections.abc import Mapping

FIELDS: Mapping[str, str] = {
    "person_id": "The person's id in the roster.",
    "person_name": "The wearer's name at that time.",
    "unassign": "Whether units that the person wears are unassigned first; else it is refused.",
    "crew": "The crew that the person belongs to; empty: none.",
    "AssignmentAnswer.role": "The wearer's function at that time, for example officer.",
    "PersonForm.role": "The person's function, for example officer.",
    "PersonView.role": "The person's function, for example officer.",
    "ListedPersonAnswer.role": "The person's function as it is afterwards.",
    "line": "Number of the line in the file, from 1.",
    "change": "What becomes of the person: add, change, or same where nothing changes.",
    "fault": "What is wrong with the line, and what to do.",
    "faulty_lines": "Lines that cannot be used: nobody is added or changed while there is one.",
    "FaultyLine.fault_code": "Code of the fault; null: it has none.",
    "PeopleImport.people": "Everybody whose line can be used.",
    "preview": "True: say what would be done, and do nothing.",
    "photo_url": "Where the photo is fetched; null: there is none.",
    "people": "Names of those who wore the unit in the incident.",
}
