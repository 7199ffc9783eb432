"""All formats, by name."""

from fuzz import of_cameras, of_devices, of_media, of_records, of_study

FORMATS = {
    form.name: form
    for room in (of_study, of_cameras, of_devices, of_records, of_media)
    for form in room.FORMATS
}
