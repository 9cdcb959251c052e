<?xml version="1.0" encoding="utf-8"?>
<!DOCTYPE TS>
<TS version="2.1" language="de_DE" sourcelanguage="en">
<context>
    <name>ActionsBar</name>
    <message>
        <source>&amp;Compare</source>
        <translation>&amp;Vergleichen</translation>
    </message>
    <message>
        <source>E&amp;xclude…</source>
        <translation>A&amp;usschließen…</translation>
    </message>
    <message>
        <source>Count &amp;again</source>
        <translation>Wieder &amp;zählen</translation>
    </message>
    <message>
        <source>Ta&amp;g…</source>
        <translation>S&amp;chlagwort…</translation>
    </message>
    <message>
        <source>Move to t&amp;rash</source>
        <translation>In den Papier&amp;korb</translation>
    </message>
    <message>
        <source>Put &amp;back</source>
        <translation>Zurückle&amp;gen</translation>
    </message>
    <message>
        <source>E&amp;xport…</source>
        <translation>E&amp;xportieren…</translation>
    </message>
    <message>
        <source>Exclude</source>
        <translation>Ausschließen</translation>
    </message>
    <message>
        <source>Add tag</source>
        <translation>Schlagwort hinzufügen</translation>
    </message>
    <message>
        <source>Undo</source>
        <translation>Rückgängig</translation>
    </message>
    <message>
        <source>Undo this (Ctrl+Z)</source>
        <translation>Rückgängig machen (Strg+Z)</translation>
    </message>
    <message>
        <source>Why these brakings must not count; the report prints it</source>
        <translation>Warum diese Bremsungen nicht zählen; der Bericht nennt es</translation>
    </message>
    <message>
        <source>Up to 40 letters, no comma</source>
        <translation>Bis zu 40 Zeichen, kein Komma</translation>
    </message>
    <message>
        <source>Enter</source>
        <translation>Eingeben</translation>
    </message>
    <message>
        <source>Lay up to four brakings over each other; one more is added to them</source>
        <translation>Bis zu vier Bremsungen übereinanderlegen; eine einzelne kommt hinzu</translation>
    </message>
    <message>
        <source>They stay in the list, struck through, and count in no statistics and no report. Asks for the reason.</source>
        <translation>Sie bleiben durchgestrichen in der Liste und zählen in keiner Statistik und keinem Bericht. Fragt nach dem Grund.</translation>
    </message>
    <message>
        <source>Excluded brakings count again</source>
        <translation>Ausgeschlossene Bremsungen zählen wieder</translation>
    </message>
    <message>
        <source>Add a short word for finding them again</source>
        <translation>Ein kurzes Wort zum Wiederfinden hinzufügen</translation>
    </message>
    <message>
        <source>Moves their files to the folder trash of the campaign; nothing is deleted. “rigctl resume” would do these brakings again. Undo moves them back.</source>
        <translation>Verschiebt ihre Dateien in den Papierkorb (Ordner „trash“ der Kampagne); nichts wird gelöscht. „rigctl resume“ würde diese Bremsungen nachholen. Rückgängig legt sie zurück.</translation>
    </message>
    <message>
        <source>Moves the files back from the trash; “rigctl resume” leaves them alone then</source>
        <translation>Legt die Dateien aus dem Papierkorb zurück; „rigctl resume“ lässt sie dann in Ruhe</translation>
    </message>
    <message>
        <source>WAV, CSV, MATLAB or HDF5 files in a folder of your choice</source>
        <translation>WAV-, CSV-, MATLAB- oder HDF5-Dateien in einen Ordner nach Wahl</translation>
    </message>
    <message>
        <source>Exclude this braking. Why?</source>
        <translation>Diese Bremsung ausschließen. Warum?</translation>
    </message>
    <message>
        <source>Exclude {0} brakings. Why?</source>
        <translation>{0} Bremsungen ausschließen. Warum?</translation>
    </message>
    <message>
        <source>door slammed, wrong disc, …</source>
        <translation>Tür zugeschlagen, falsche Scheibe, …</translation>
    </message>
    <message>
        <source>Tag for {0} chosen</source>
        <translation>Schlagwort für {0} gewählte</translation>
    </message>
    <message>
        <source>one short word</source>
        <translation>ein kurzes Wort</translation>
    </message>
</context>
<context>
    <name>AlarmBar</name>
    <message>
        <source>Acknowledge</source>
        <translation>Quittieren</translation>
    </message>
    <message>
        <source>Say that this alarm has been seen; it stays in the list.</source>
        <translation>Diesen Alarm als gesehen melden; er bleibt in der Liste.</translation>
    </message>
    <message>
        <source>■  STOP  (F12)</source>
        <translation>■  STOPP  (F12)</translation>
    </message>
    <message>
        <source>Stops by software: releases the pressure, brings the disc to rest, ends the run. This is NOT the emergency stop: use the red mushroom button of the rig in danger.</source>
        <translation>Hält per Software an: lässt den Druck ab, bringt die Scheibe zum Stillstand, beendet den Lauf. Das ist NICHT der Not-Halt: bei Gefahr den roten Pilztaster am Prüfstand drücken.</translation>
    </message>
    <message>
        <source>software stop,
not the emergency stop</source>
        <translation>Software-Stopp,
kein Not-Halt</translation>
    </message>
</context>
<context>
    <name>AlarmModel</name>
    <message>
        <source>The acknowledgement was not journaled: {0}</source>
        <translation>Die Quittierung kam nicht ins Journal: {0}</translation>
    </message>
    <message>
        <source>Values are not watched: {0}</source>
        <translation>Werte werden nicht überwacht: {0}</translation>
    </message>
    <message>
        <source>The calibration of {0} is overdue since {1}.</source>
        <translation>Kalibrierung {0} ist seit {1} überfällig.</translation>
    </message>
    <message>
        <source>Calibrate it on the Service page.</source>
        <translation>Auf der Seite Service kalibrieren.</translation>
    </message>
</context>
<context>
    <name>AlarmTable</name>
    <message>
        <source>Severity</source>
        <translation>Schwere</translation>
    </message>
    <message>
        <source>Time</source>
        <translation>Zeit</translation>
    </message>
    <message>
        <source>Times</source>
        <translation>Anzahl</translation>
    </message>
    <message>
        <source>What</source>
        <translation>Was</translation>
    </message>
    <message>
        <source>What to do</source>
        <translation>Was zu tun ist</translation>
    </message>
    <message>
        <source>Acknowledged</source>
        <translation>Quittiert</translation>
    </message>
    <message>
        <source>Alarm</source>
        <translation>Alarm</translation>
    </message>
    <message>
        <source>Warning</source>
        <translation>Warnung</translation>
    </message>
    <message>
        <source>  (lasts)</source>
        <translation>  (dauert an)</translation>
    </message>
</context>
<context>
    <name>AlarmsTab</name>
    <message>
        <source>&amp;Acknowledge the selected</source>
        <translation>A&amp;usgewählte quittieren</translation>
    </message>
    <message>
        <source>Say that they have been seen; they stay in the list (Ctrl+A: all)</source>
        <translation>Als gesehen melden; sie bleiben in der Liste (Strg+A: alle)</translation>
    </message>
    <message>
        <source>Acknowledge a&amp;ll</source>
        <translation>A&amp;lle quittieren</translation>
    </message>
    <message>
        <source>Say that all have been seen; each is journaled</source>
        <translation>Alle als gesehen melden; jede Quittierung kommt ins Journal</translation>
    </message>
    <message>
        <source>Only what is not acknowledged</source>
        <translation>Nur nicht quittierte</translation>
    </message>
    <message>
        <source>Hide what somebody has seen</source>
        <translation>Ausblenden, was schon jemand gesehen hat</translation>
    </message>
    <message>
        <source>No alarm. Trips, refusals, broken-off brakings and values near the watchdog&apos;s limits appear here with what to do; the newest also stands in the bar below.</source>
        <translation>Kein Alarm. Auslösungen, Ablehnungen, abgebrochene Bremsungen und Werte nahe den Grenzen des Wächters erscheinen hier, mit dem, was zu tun ist; der neueste steht auch in der Leiste unten.</translation>
    </message>
</context>
<context>
    <name>Annotator</name>
    <message>
        <source>{0} excluded</source>
        <translation>{0} ausgeschlossen</translation>
    </message>
    <message>
        <source>{0} counted again</source>
        <translation>{0} wieder gezählt</translation>
    </message>
    <message>
        <source>{0} tagged “{1}”</source>
        <translation>{0} mit Schlagwort „{1}“</translation>
    </message>
    <message>
        <source>tag “{1}” removed from {0}</source>
        <translation>Schlagwort „{1}“ von {0} entfernt</translation>
    </message>
    <message>
        <source>Note of braking {0} saved</source>
        <translation>Notiz zu Bremsung {0} gespeichert</translation>
    </message>
    <message>
        <source>Noise rating of braking {0} saved</source>
        <translation>Geräuschnote von Bremsung {0} gespeichert</translation>
    </message>
    <message>
        <source>{0} moved to the trash</source>
        <translation>{0} in den Papierkorb gelegt</translation>
    </message>
    <message>
        <source>{0} put back from the trash</source>
        <translation>{0} aus dem Papierkorb zurückgelegt</translation>
    </message>
    <message>
        <source>Braking {0}</source>
        <translation>Bremsung {0}</translation>
    </message>
    <message>
        <source>{0} brakings</source>
        <translation>{0} Bremsungen</translation>
    </message>
    <message>
        <source>Undone: {0}</source>
        <translation>Rückgängig: {0}</translation>
    </message>
</context>
<context>
    <name>AskLine</name>
    <message>
        <source>Cancel</source>
        <translation>Abbrechen</translation>
    </message>
    <message>
        <source>Do nothing (Esc)</source>
        <translation>Nichts tun (Esc)</translation>
    </message>
</context>
<context>
    <name>AxisChoice</name>
    <message>
        <source>Slider along this axis; type to search</source>
        <translation>Regler auf dieser Achse; zum Suchen tippen</translation>
    </message>
    <message>
        <source>Least value on this axis</source>
        <translation>Kleinster Wert dieser Achse</translation>
    </message>
    <message>
        <source>Largest value on this axis</source>
        <translation>Größter Wert dieser Achse</translation>
    </message>
</context>
<context>
    <name>BoundsField</name>
    <message>
        <source>from</source>
        <translation>von</translation>
    </message>
    <message>
        <source>to</source>
        <translation>bis</translation>
    </message>
    <message>
        <source>Show set-points from this value; empty: all</source>
        <translation>Sollwerte ab diesem Wert zeigen; leer: alle</translation>
    </message>
    <message>
        <source>Show set-points up to this value; empty: all</source>
        <translation>Sollwerte bis zu diesem Wert zeigen; leer: alle</translation>
    </message>
    <message>
        <source>“{0}” is no number</source>
        <translation>„{0}“ ist keine Zahl</translation>
    </message>
    <message>
        <source>“from” is above “to”</source>
        <translation>„von“ liegt über „bis“</translation>
    </message>
</context>
<context>
    <name>BrakeChoice</name>
    <message>
        <source>Other file…</source>
        <translation>Andere Datei…</translation>
    </message>
    <message>
        <source>Choose a brake file</source>
        <translation>Bremsendatei wählen</translation>
    </message>
    <message>
        <source>Brake files (*.toml)</source>
        <translation>Bremsendateien (*.toml)</translation>
    </message>
</context>
<context>
    <name>BrakingPane</name>
    <message>
        <source>&amp;Rows</source>
        <translation>Ze&amp;ilen</translation>
    </message>
    <message>
        <source>Which rows are shown; where there is little room, the large view shows all</source>
        <translation>Welche Zeilen gezeigt werden; bei wenig Platz zeigt die große Ansicht alle</translation>
    </message>
    <message>
        <source>Result</source>
        <translation>Ergebnis</translation>
    </message>
    <message>
        <source>Value</source>
        <translation>Wert</translation>
    </message>
    <message>
        <source>Unit</source>
        <translation>Einheit</translation>
    </message>
    <message>
        <source>Name</source>
        <translation>Name</translation>
    </message>
    <message>
        <source>Events</source>
        <translation>Ereignisse</translation>
    </message>
    <message>
        <source>Results</source>
        <translation>Ergebnisse</translation>
    </message>
    <message>
        <source>Notes</source>
        <translation>Notizen</translation>
    </message>
    <message>
        <source>Marks</source>
        <translation>Marken</translation>
    </message>
    <message>
        <source>Metadata</source>
        <translation>Metadaten</translation>
    </message>
    <message>
        <source>No braking chosen</source>
        <translation>Keine Bremsung gewählt</translation>
    </message>
    <message>
        <source>Choose a braking in the table, or click a dot or a cell in a figure.</source>
        <translation>Eine Bremsung in der Tabelle wählen oder einen Punkt oder ein Feld in einer Grafik anklicken.</translation>
    </message>
    <message>
        <source>Excluded, does not count: {0} ({1})</source>
        <translation>Ausgeschlossen, zählt nicht: {0} ({1})</translation>
    </message>
    <message>
        <source>In the trash: “rigctl resume” would do this braking again.</source>
        <translation>Im Papierkorb: „rigctl resume“ würde diese Bremsung nachholen.</translation>
    </message>
    <message>
        <source>mean µ {0}</source>
        <translation>µ im Mittel {0}</translation>
    </message>
    <message>
        <source>recorded without sound</source>
        <translation>ohne Ton aufgezeichnet</translation>
    </message>
    <message>
        <source>squeal {0}, {1}</source>
        <translation>Quietschen {0}, {1}</translation>
    </message>
    <message>
        <source>no squeal</source>
        <translation>kein Quietschen</translation>
    </message>
    <message>
        <source>channels</source>
        <translation>Kanäle</translation>
    </message>
    <message>
        <source>ordered</source>
        <translation>Auftrag</translation>
    </message>
    <message>
        <source>evaluation</source>
        <translation>Auswertung</translation>
    </message>
    <message>
        <source>file</source>
        <translation>Datei</translation>
    </message>
    <message>
        <source>Braking {0}</source>
        <translation>Bremsung {0}</translation>
    </message>
    <message>
        <source>Frequency</source>
        <translation>Frequenz</translation>
    </message>
    <message>
        <source>Sound</source>
        <translation>Schall</translation>
    </message>
    <message>
        <source>Level</source>
        <translation>Pegel</translation>
    </message>
    <message>
        <source>Pressure</source>
        <translation>Druck</translation>
    </message>
    <message>
        <source>Torque</source>
        <translation>Moment</translation>
    </message>
    <message>
        <source>Speed</source>
        <translation>Drehzahl</translation>
    </message>
    <message>
        <source>Disc</source>
        <translation>Scheibe</translation>
    </message>
    <message>
        <source>Friction</source>
        <translation>Reibung</translation>
    </message>
    <message>
        <source>Spectrogram, level per line</source>
        <translation>Spektrogramm, Pegel je Linie</translation>
    </message>
    <message>
        <source>Sound pressure</source>
        <translation>Schalldruck</translation>
    </message>
    <message>
        <source>Sound level, Fast</source>
        <translation>Schallpegel, Fast</translation>
    </message>
    <message>
        <source>Brake pressure</source>
        <translation>Bremsdruck</translation>
    </message>
    <message>
        <source>Friction torque</source>
        <translation>Reibmoment</translation>
    </message>
    <message>
        <source>Disc temperature</source>
        <translation>Scheibentemperatur</translation>
    </message>
    <message>
        <source>Coefficient of friction</source>
        <translation>Reibwert</translation>
    </message>
</context>
<context>
    <name>BrakingTableModel</name>
    <message>
        <source>Click: sort. Right click: choose columns.</source>
        <translation>Klick: sortieren. Rechtsklick: Spalten wählen.</translation>
    </message>
    <message>
        <source>In the trash: “rigctl resume” would do this braking again.</source>
        <translation>Im Papierkorb: „rigctl resume“ würde diese Bremsung nachholen.</translation>
    </message>
    <message>
        <source>Excluded, does not count: {0} ({1})</source>
        <translation>Ausgeschlossen, zählt nicht: {0} ({1})</translation>
    </message>
    <message>
        <source>No.</source>
        <translation>Nr.</translation>
    </message>
    <message>
        <source>Sequence</source>
        <translation>Sequenz</translation>
    </message>
    <message>
        <source>State</source>
        <translation>Zustand</translation>
    </message>
    <message>
        <source>T
°C</source>
        <translation>T
°C</translation>
    </message>
    <message>
        <source>n
1/min</source>
        <translation>n
1/min</translation>
    </message>
    <message>
        <source>p
bar</source>
        <translation>p
bar</translation>
    </message>
    <message>
        <source>mu
mean</source>
        <translation>µ
Mittel</translation>
    </message>
    <message>
        <source>Squeal
dB</source>
        <translation>Pegel
dB</translation>
    </message>
    <message>
        <source>Squeal
frequency</source>
        <translation>Quietsch-
frequenz</translation>
    </message>
    <message>
        <source>Noise
rating</source>
        <translation>Note
1…9</translation>
    </message>
    <message>
        <source>Note</source>
        <translation>Notiz</translation>
    </message>
    <message>
        <source>Number in the program</source>
        <translation>Nummer im Programm</translation>
    </message>
    <message>
        <source>Sequence of the program</source>
        <translation>Sequenz des Programms</translation>
    </message>
    <message>
        <source>What has become of the braking</source>
        <translation>Was aus der Bremsung geworden ist</translation>
    </message>
    <message>
        <source>Set-point of the disc temperature at the start; (measured) where the disc is taken as it is</source>
        <translation>Sollwert der Scheibentemperatur zu Beginn; (gemessen), wo die Scheibe genommen wird, wie sie ist</translation>
    </message>
    <message>
        <source>Set-point of the speed, at the beginning → at the end</source>
        <translation>Sollwert der Drehzahl, am Anfang → am Ende</translation>
    </message>
    <message>
        <source>Set-point of the pressure</source>
        <translation>Sollwert des Drucks</translation>
    </message>
    <message>
        <source>Mean coefficient of friction</source>
        <translation>Mittlerer Reibwert</translation>
    </message>
    <message>
        <source>Level of the loudest squeal; none: judged without squeal</source>
        <translation>Pegel des lautesten Quietschens; keins: als quietschfrei bewertet</translation>
    </message>
    <message>
        <source>Frequency of the loudest squeal</source>
        <translation>Frequenz des lautesten Quietschens</translation>
    </message>
    <message>
        <source>Subjective noise rating, keys 1 to 9</source>
        <translation>Subjektive Geräuschnote, Tasten 1 bis 9</translation>
    </message>
    <message>
        <source>What the operator has said (key N), and why it is not complete</source>
        <translation>Was notiert wurde (Taste N) und warum sie nicht vollständig ist</translation>
    </message>
    <message>
        <source>waiting</source>
        <translation>wartet</translation>
    </message>
    <message>
        <source>● conditioning</source>
        <translation>● temperiert</translation>
    </message>
    <message>
        <source>● braking</source>
        <translation>● bremst</translation>
    </message>
    <message>
        <source>✓ complete</source>
        <translation>✓ vollständig</translation>
    </message>
    <message>
        <source>▲ incomplete</source>
        <translation>▲ unvollständig</translation>
    </message>
    <message>
        <source>↷ skipped</source>
        <translation>↷ übersprungen</translation>
    </message>
    <message>
        <source>▲ recovered</source>
        <translation>▲ gerettet</translation>
    </message>
    <message>
        <source>none</source>
        <translation>keins</translation>
    </message>
</context>
<context>
    <name>CalibrationsTab</name>
    <message>
        <source>Torque</source>
        <translation>Moment</translation>
    </message>
    <message>
        <source>By lever and weights, in both directions</source>
        <translation>Mit Hebel und Gewichten, in beiden Richtungen</translation>
    </message>
    <message>
        <source>Microphone</source>
        <translation>Mikrofon</translation>
    </message>
    <message>
        <source>By a calibrator of 94 or 114 dB</source>
        <translation>Mit einem Kalibrator von 94 oder 114 dB</translation>
    </message>
    <message>
        <source>Emissivity</source>
        <translation>Emissionsgrad</translation>
    </message>
    <message>
        <source>By a contact thermometer</source>
        <translation>Mit einem Kontaktthermometer</translation>
    </message>
    <message>
        <source>Date</source>
        <translation>Datum</translation>
    </message>
    <message>
        <source>Quantity</source>
        <translation>Größe</translation>
    </message>
    <message>
        <source>Result</source>
        <translation>Ergebnis</translation>
    </message>
    <message>
        <source>Operator</source>
        <translation>Bearbeiter</translation>
    </message>
    <message>
        <source>Due</source>
        <translation>Fällig</translation>
    </message>
    <message>
        <source>No calibration has been made here yet. [Calibrate …] leads through it step by step; every result is kept with its readings, the newest of each quantity holds.</source>
        <translation>Hier wurde noch nicht kalibriert. [Kalibrieren …] führt Schritt für Schritt durch; jedes Ergebnis bleibt mit seinen Ablesungen erhalten, es gilt das neueste jeder Größe.</translation>
    </message>
    <message>
        <source>Calibrations are made on a running rig: choose one on the Manual page and connect; it need not be enabled. Then its calibrations and their due dates stand here.</source>
        <translation>Kalibriert wird an einem laufenden Prüfstand: auf der Seite Manuell einen wählen und verbinden; freigegeben sein muss er nicht. Dann stehen hier seine Kalibrierungen und ihre Fälligkeit.</translation>
    </message>
    <message>
        <source>Rig: {0}. Kept in {1}</source>
        <translation>Prüfstand: {0}. Abgelegt in {1}</translation>
    </message>
    <message>
        <source>The readings of this calibration are not saved.</source>
        <translation>Die Ablesungen dieser Kalibrierung sind nicht gespeichert.</translation>
    </message>
    <message>
        <source>Leave, lose them</source>
        <translation>Verlassen, verwerfen</translation>
    </message>
    <message>
        <source>Go on</source>
        <translation>Weitermachen</translation>
    </message>
    <message>
        <source>Readings of a calibration that is not saved</source>
        <translation>Ablesungen einer nicht gespeicherten Kalibrierung</translation>
    </message>
    <message>
        <source>The session has ended: no more readings can be taken.</source>
        <translation>Die Sitzung ist beendet: keine weiteren Ablesungen möglich.</translation>
    </message>
</context>
<context>
    <name>CampaignPane</name>
    <message>
        <source>Campaigns, newest first</source>
        <translation>Kampagnen, neueste zuerst</translation>
    </message>
    <message>
        <source>&amp;Open folder…</source>
        <translation>&amp;Ordner öffnen…</translation>
    </message>
    <message>
        <source>A campaign, or a folder of them</source>
        <translation>Eine Kampagne oder ein Ordner davon</translation>
    </message>
    <message>
        <source>Show &amp;files</source>
        <translation>&amp;Dateien zeigen</translation>
    </message>
    <message>
        <source>The campaign in the file manager</source>
        <translation>Die Kampagne in der Dateiverwaltung</translation>
    </message>
    <message>
        <source>Open re&amp;port</source>
        <translation>&amp;Bericht öffnen</translation>
    </message>
    <message>
        <source>The report in the browser</source>
        <translation>Der Bericht im Browser</translation>
    </message>
    <message>
        <source>Build report</source>
        <translation>Bericht erstellen</translation>
    </message>
    <message>
        <source>As “rigctl report”; without excluded brakings</source>
        <translation>Wie „rigctl report“; ohne ausgeschlossene Bremsungen</translation>
    </message>
    <message>
        <source>Building …</source>
        <translation>Wird erstellt …</translation>
    </message>
    <message>
        <source>no date</source>
        <translation>ohne Datum</translation>
    </message>
    <message>
        <source>{0} brakings</source>
        <translation>{0} Bremsungen</translation>
    </message>
    <message>
        <source>simulated rig</source>
        <translation>simulierter Prüfstand</translation>
    </message>
    <message>
        <source>campaign.toml cannot be read: {0}</source>
        <translation>campaign.toml ist nicht lesbar: {0}</translation>
    </message>
</context>
<context>
    <name>ComparePane</name>
    <message>
        <source>What is laid over each other</source>
        <translation>Was übereinandergelegt wird</translation>
    </message>
    <message>
        <source>Spectrum, mean while braking</source>
        <translation>Spektrum, Mittel während der Bremsung</translation>
    </message>
    <message>
        <source>Spectrum, largest while braking</source>
        <translation>Spektrum, Maximum während der Bremsung</translation>
    </message>
    <message>
        <source>Coefficient of friction over time</source>
        <translation>Reibwert über der Zeit</translation>
    </message>
    <message>
        <source>Sound level over time</source>
        <translation>Schallpegel über der Zeit</translation>
    </message>
    <message>
        <source>Pressure over time</source>
        <translation>Druck über der Zeit</translation>
    </message>
    <message>
        <source>Torque over time</source>
        <translation>Moment über der Zeit</translation>
    </message>
    <message>
        <source>C&amp;lear</source>
        <translation>&amp;Leeren</translation>
    </message>
    <message>
        <source>Take all brakings out of the comparison</source>
        <translation>Alle Bremsungen aus dem Vergleich nehmen</translation>
    </message>
    <message>
        <source>Choose two to four brakings in the table and press Compare. Further ones are added, also from other campaigns.</source>
        <translation>Zwei bis vier Bremsungen in der Tabelle wählen und Vergleichen drücken. Weitere kommen hinzu, auch aus anderen Kampagnen.</translation>
    </message>
    <message>
        <source>Show all</source>
        <translation>Alles zeigen</translation>
    </message>
    <message>
        <source>Result</source>
        <translation>Ergebnis</translation>
    </message>
    <message>
        <source>Unit</source>
        <translation>Einheit</translation>
    </message>
    <message>
        <source>Braking {0}</source>
        <translation>Bremsung {0}</translation>
    </message>
    <message>
        <source>Time since the first sample [s]</source>
        <translation>Zeit ab dem ersten Abtastwert [s]</translation>
    </message>
    <message>
        <source>Frequency [kHz]</source>
        <translation>Frequenz [kHz]</translation>
    </message>
    <message>
        <source>Level per line [dB]</source>
        <translation>Pegel je Linie [dB]</translation>
    </message>
    <message>
        <source>Coefficient of friction µ</source>
        <translation>Reibwert µ</translation>
    </message>
    <message>
        <source>Sound level, Fast [dB]</source>
        <translation>Schallpegel, Fast [dB]</translation>
    </message>
    <message>
        <source>Pressure [bar]</source>
        <translation>Druck [bar]</translation>
    </message>
    <message>
        <source>Torque [N·m]</source>
        <translation>Moment [N·m]</translation>
    </message>
    <message>
        <source>Set pressure</source>
        <translation>Solldruck</translation>
    </message>
    <message>
        <source>Disc, start</source>
        <translation>Scheibe, Beginn</translation>
    </message>
    <message>
        <source>Speed, mean</source>
        <translation>Drehzahl, Mittel</translation>
    </message>
    <message>
        <source>Mean µ</source>
        <translation>µ im Mittel</translation>
    </message>
    <message>
        <source>Torque, mean</source>
        <translation>Moment, Mittel</translation>
    </message>
    <message>
        <source>Squeal frequency</source>
        <translation>Quietschfrequenz</translation>
    </message>
    <message>
        <source>Squeal level</source>
        <translation>Quietschpegel</translation>
    </message>
    <message>
        <source>Equivalent level, A</source>
        <translation>Äquivalenter Pegel, A</translation>
    </message>
    <message>
        <source>Highest level</source>
        <translation>Höchster Pegel</translation>
    </message>
</context>
<context>
    <name>ConnectPanel</name>
    <message>
        <source>Move motor and brake by hand</source>
        <translation>Motor und Bremse von Hand fahren</translation>
    </message>
    <message>
        <source>1.  Choose a rig and connect. A controller is started for it; closing this window does not stop it.
2.  Enable: the watchdog checks the rig at rest, then motor and brake may move.
3.  Type speed and pressure; Enter applies. The space bar releases the pressure.
4.  Record a braking: it is stored with all signals and shown on the Data page.</source>
        <translation>1.  Prüfstand wählen und verbinden. Eine Steuerung wird für ihn gestartet; Schließen dieses Fensters hält sie nicht an.
2.  Freigeben: der Wächter prüft den Prüfstand im Stillstand, dann dürfen Motor und Bremse sich bewegen.
3.  Drehzahl und Druck eintippen; Enter übernimmt. Die Leertaste lässt den Druck ab.
4.  Eine Bremsung aufzeichnen: sie wird mit allen Signalen gespeichert und auf der Seite Daten gezeigt.</translation>
    </message>
    <message>
        <source>Rig files of the folder “rigs” of the configuration</source>
        <translation>Prüfstandsdateien aus dem Ordner „rigs“ der Konfiguration</translation>
    </message>
    <message>
        <source>by the &amp;clock</source>
        <translation>nach der &amp;Uhr</translation>
    </message>
    <message>
        <source>The simulated rig takes as long as a real one: you can watch and listen</source>
        <translation>Der simulierte Prüfstand braucht so lange wie ein echter: zum Zusehen und Zuhören</translation>
    </message>
    <message>
        <source>as &amp;fast as possible</source>
        <translation>so &amp;schnell wie möglich</translation>
    </message>
    <message>
        <source>Virtual time: heating takes seconds instead of minutes</source>
        <translation>Virtuelle Zeit: Heizen dauert Sekunden statt Minuten</translation>
    </message>
    <message>
        <source>Co&amp;nnect</source>
        <translation>&amp;Verbinden</translation>
    </message>
    <message>
        <source>Start a controller for this rig; nothing moves yet</source>
        <translation>Eine Steuerung für diesen Prüfstand starten; noch bewegt sich nichts</translation>
    </message>
    <message>
        <source>While a program runs, this page shows readings and live sound only; the program is watched and held on the page Run.</source>
        <translation>Während ein Programm läuft, zeigt diese Seite nur Messwerte und Schall; verfolgt und angehalten wird das Programm auf der Seite Lauf.</translation>
    </message>
    <message>
        <source>&amp;Rig</source>
        <translation>&amp;Prüfstand</translation>
    </message>
    <message>
        <source>Time runs</source>
        <translation>Zeit läuft</translation>
    </message>
    <message>
        <source>Starting the controller …</source>
        <translation>Steuerung startet …</translation>
    </message>
    <message>
        <source>▲ {0} cannot be read</source>
        <translation>▲ {0} ist nicht lesbar</translation>
    </message>
    <message>
        <source>SIMULATED</source>
        <translation>SIMULIERT</translation>
    </message>
    <message>
        <source>REAL RIG</source>
        <translation>ECHTER PRÜFSTAND</translation>
    </message>
    <message>
        <source>There is no rig file. Put one into the folder “rigs”.</source>
        <translation>Es gibt keine Prüfstandsdatei. Eine in den Ordner „rigs“ legen.</translation>
    </message>
    <message>
        <source>Nothing real moves: every device is played by this computer.</source>
        <translation>Nichts bewegt sich wirklich: alle Geräte werden von diesem Rechner nachgebildet.</translation>
    </message>
    <message>
        <source>A real motor and a real brake: look at the rig before you enable.</source>
        <translation>Echter Motor, echte Bremse: vor dem Freigeben nach dem Prüfstand sehen.</translation>
    </message>
</context>
<context>
    <name>Controls</name>
    <message>
        <source>Release pressure   (Space)</source>
        <translation>Druck ablassen   (Leertaste)</translation>
    </message>
    <message>
        <source>Takes the pressure off at once and ends a course, a recording or heating</source>
        <translation>Nimmt den Druck sofort weg und beendet Verlauf, Aufzeichnung oder Heizen</translation>
    </message>
</context>
<context>
    <name>CoursePlots</name>
    <message>
        <source>first {0}</source>
        <translation>erste {0}</translation>
    </message>
    <message>
        <source>How many brakings of the sequence are drawn</source>
        <translation>Wie viele Bremsungen der Sequenz gezeichnet werden</translation>
    </message>
    <message>
        <source>Show all</source>
        <translation>Alles zeigen</translation>
    </message>
    <message>
        <source>Back to the whole time axis</source>
        <translation>Zurück zur ganzen Zeitachse</translation>
    </message>
    <message>
        <source>Drawn course of the first brakings</source>
        <translation>Gezeichneter Verlauf der ersten Bremsungen</translation>
    </message>
    <message>
        <source>T</source>
        <translation>T</translation>
    </message>
    <message>
        <source>n</source>
        <translation>n</translation>
    </message>
    <message>
        <source>p</source>
        <translation>p</translation>
    </message>
    <message>
        <source>time / min</source>
        <translation>Zeit / min</translation>
    </message>
    <message>
        <source>Course</source>
        <translation>Verlauf</translation>
    </message>
    <message>
        <source>From braking {0}</source>
        <translation>Ab Bremsung {0}</translation>
    </message>
    <message>
        <source>braking {0}</source>
        <translation>Bremsung {0}</translation>
    </message>
    <message>
        <source>Copy the picture</source>
        <translation>Bild kopieren</translation>
    </message>
    <message>
        <source>Save the picture …</source>
        <translation>Bild speichern …</translation>
    </message>
    <message>
        <source>Save the picture</source>
        <translation>Bild speichern</translation>
    </message>
    <message>
        <source>Picture (*.png)</source>
        <translation>Bild (*.png)</translation>
    </message>
</context>
<context>
    <name>DataPage</name>
    <message>
        <source>Campaign or folder of campaigns</source>
        <translation>Kampagne oder Ordner mit Kampagnen</translation>
    </message>
    <message>
        <source>No program of this computer opens {0}</source>
        <translation>Kein Programm dieses Rechners öffnet {0}</translation>
    </message>
    <message>
        <source>Report built: {0}</source>
        <translation>Bericht erstellt: {0}</translation>
    </message>
    <message>
        <source>Braking {0} is not in this campaign</source>
        <translation>Bremsung {0} gehört nicht zu dieser Kampagne</translation>
    </message>
    <message>
        <source>&lt;p&gt;&lt;b&gt;Data&lt;/b&gt;: choose a campaign, then a braking. Statistics, figures and report count complete brakings that are not excluded. Nothing is deleted: excluded brakings stay in the list, the trash is a folder of the campaign.&lt;/p&gt;&lt;p&gt;&lt;b&gt;Enter&lt;/b&gt; or &lt;b&gt;F11&lt;/b&gt;: large view · &lt;b&gt;Esc&lt;/b&gt;: back · &lt;b&gt;Ctrl+F&lt;/b&gt;: words in notes · &lt;b&gt;Ctrl+P&lt;/b&gt;: play the sound · &lt;b&gt;Delete&lt;/b&gt;: move to the trash · &lt;b&gt;Ctrl+Z&lt;/b&gt;: undo · &lt;b&gt;F5&lt;/b&gt;: look again. Ctrl or Shift and click choose several brakings. The wheel zooms the time; a right click on a plot copies or saves its picture.&lt;/p&gt;</source>
        <translation>&lt;p&gt;&lt;b&gt;Daten&lt;/b&gt;: eine Kampagne wählen, dann eine Bremsung. Statistik, Grafiken und Bericht zählen vollständige Bremsungen, die nicht ausgeschlossen sind. Nichts wird gelöscht: Ausgeschlossene bleiben in der Liste, der Papierkorb ist ein Ordner der Kampagne.&lt;/p&gt;&lt;p&gt;&lt;b&gt;Enter&lt;/b&gt; oder &lt;b&gt;F11&lt;/b&gt;: große Ansicht · &lt;b&gt;Esc&lt;/b&gt;: zurück · &lt;b&gt;Strg+F&lt;/b&gt;: Wörter in Notizen · &lt;b&gt;Strg+P&lt;/b&gt;: Ton abspielen · &lt;b&gt;Entf&lt;/b&gt;: in den Papierkorb · &lt;b&gt;Strg+Z&lt;/b&gt;: rückgängig · &lt;b&gt;F5&lt;/b&gt;: neu einlesen. Strg oder Umschalt und Klick wählt mehrere Bremsungen. Das Rad dehnt die Zeit; ein Rechtsklick auf eine Grafik kopiert oder speichert ihr Bild.&lt;/p&gt;</translation>
    </message>
</context>
<context>
    <name>DeviceCard</name>
    <message>
        <source>test passed</source>
        <translation>Prüfung bestanden</translation>
    </message>
    <message>
        <source>▲ look at the warnings</source>
        <translation>▲ Warnungen beachten</translation>
    </message>
    <message>
        <source>▲ failed</source>
        <translation>▲ durchgefallen</translation>
    </message>
    <message>
        <source>simulated, no wires</source>
        <translation>simuliert, ohne Leitungen</translation>
    </message>
    <message>
        <source>▲ unsafe: </source>
        <translation>▲ unsicher: </translation>
    </message>
</context>
<context>
    <name>DevicesTab</name>
    <message>
        <source>Rig file whose devices are tested</source>
        <translation>Prüfstandsdatei, deren Geräte geprüft werden</translation>
    </message>
    <message>
        <source>&amp;Test devices</source>
        <translation>Geräte p&amp;rüfen</translation>
    </message>
    <message>
        <source>Open each device one by one and ask it; nothing moves. Same as: rigctl devices test RIG</source>
        <translation>Jedes Gerät einzeln öffnen und abfragen; nichts bewegt sich. Wie: rigctl devices test PRÜFSTAND</translation>
    </message>
    <message>
        <source>Drive</source>
        <translation>Antrieb</translation>
    </message>
    <message>
        <source>Brake pressure</source>
        <translation>Bremsdruck</translation>
    </message>
    <message>
        <source>Ventilator</source>
        <translation>Lüfter</translation>
    </message>
    <message>
        <source>Acquisition</source>
        <translation>Messwerterfassung</translation>
    </message>
    <message>
        <source>Safety</source>
        <translation>Sicherheit</translation>
    </message>
    <message>
        <source>No rig is connected. [Test devices] opens each device of a rig file one by one, asks who it is and what is set in an unsafe way; nothing moves.</source>
        <translation>Kein Prüfstand ist verbunden. [Geräte prüfen] öffnet jedes Gerät einer Prüfstandsdatei einzeln, fragt, wer es ist und was unsicher eingestellt ist; nichts bewegt sich.</translation>
    </message>
    <message>
        <source>{0}: identities from its start, values as they come. A test needs a rig that is not running.</source>
        <translation>{0}: Kennungen vom Start, Werte laufend. Zum Prüfen darf der Prüfstand nicht laufen.</translation>
    </message>
    <message>
        <source>Choose a rig first.</source>
        <translation>Zuerst einen Prüfstand wählen.</translation>
    </message>
    <message>
        <source>&amp;Cancel the test</source>
        <translation>&amp;Prüfung abbrechen</translation>
    </message>
    <message>
        <source>Testing the devices of {0} …</source>
        <translation>Geräte von {0} werden geprüft …</translation>
    </message>
    <message>
        <source>The test was cancelled.</source>
        <translation>Die Prüfung wurde abgebrochen.</translation>
    </message>
    <message>
        <source>Failed: {0}.</source>
        <translation>Durchgefallen: {0}.</translation>
    </message>
    <message>
        <source>{0} settings are unsafe: see below.</source>
        <translation>{0} Einstellungen sind unsicher: siehe unten.</translation>
    </message>
    <message>
        <source>All devices of {0} have answered.</source>
        <translation>Alle Geräte von {0} haben geantwortet.</translation>
    </message>
    <message>
        <source>The test could not be started.</source>
        <translation>Die Prüfung konnte nicht starten.</translation>
    </message>
</context>
<context>
    <name>DiscBox</name>
    <message>
        <source>Disc temperature</source>
        <translation>Scheibentemperatur</translation>
    </message>
    <message>
        <source>Temperature that the disc is brought to</source>
        <translation>Temperatur, auf die die Scheibe gebracht wird</translation>
    </message>
    <message>
        <source>&amp;Heat or cool</source>
        <translation>&amp;Heizen/Kühlen</translation>
    </message>
    <message>
        <source>Cooling air</source>
        <translation>Kühlluft</translation>
    </message>
    <message>
        <source>&amp;Blow</source>
        <translation>&amp;Blasen</translation>
    </message>
    <message>
        <source>Air off</source>
        <translation>Luft aus</translation>
    </message>
    <message>
        <source>Temp.</source>
        <translation>Temp.</translation>
    </message>
    <message>
        <source>&amp;Air</source>
        <translation>L&amp;uft</translation>
    </message>
    <message>
        <source>Drags the brake to heat the disc, or blows air to cool it; any other order ends it</source>
        <translation>Heizt die Scheibe durch Schleifen oder kühlt sie mit Luft; jeder andere Befehl beendet es</translation>
    </message>
    <message>
        <source>Blow this much cooling air (Enter)</source>
        <translation>So viel Kühlluft blasen (Enter)</translation>
    </message>
    <message>
        <source>Stop the ventilator</source>
        <translation>Lüfter anhalten</translation>
    </message>
</context>
<context>
    <name>DueCard</name>
    <message>
        <source>Calibrate …</source>
        <translation>Kalibrieren …</translation>
    </message>
    <message>
        <source>valid until {0}</source>
        <translation>gültig bis {0}</translation>
    </message>
    <message>
        <source>▲ due on {0}</source>
        <translation>▲ fällig am {0}</translation>
    </message>
    <message>
        <source>▲ overdue since {0}</source>
        <translation>▲ überfällig seit {0}</translation>
    </message>
    <message>
        <source>never calibrated</source>
        <translation>nie kalibriert</translation>
    </message>
</context>
<context>
    <name>EmptyPane</name>
    <message>
        <source>No braking has been recorded yet</source>
        <translation>Noch keine Bremsung aufgezeichnet</translation>
    </message>
    <message>
        <source>&amp;Brake by hand</source>
        <translation>&amp;Von Hand bremsen</translation>
    </message>
    <message>
        <source>Page Manual: start the simulated rig, enable it, start a braking</source>
        <translation>Seite Manuell: simulierten Prüfstand starten, freigeben, eine Bremsung starten</translation>
    </message>
    <message>
        <source>&amp;Write a test program</source>
        <translation>&amp;Prüfprogramm schreiben</translation>
    </message>
    <message>
        <source>Page Sequence: a matrix of pressures and temperatures, run unattended</source>
        <translation>Seite Sequenz: eine Matrix aus Drücken und Temperaturen, läuft unbeaufsichtigt</translation>
    </message>
    <message>
        <source>&amp;Open folder…</source>
        <translation>&amp;Ordner öffnen…</translation>
    </message>
    <message>
        <source>A campaign, or a folder of them</source>
        <translation>Eine Kampagne oder ein Ordner davon</translation>
    </message>
    <message>
        <source>Brakings are kept in campaigns, folders below {0}; there is none yet. The simulated rig records one in a few seconds and needs no hardware: on the page Manual choose it, enable it and start a braking, or let a test program run.</source>
        <translation>Bremsungen liegen in Kampagnen, Ordnern unter {0}; noch gibt es keine. Der simulierte Prüfstand zeichnet in wenigen Sekunden eine auf und braucht keine Hardware: auf der Seite Manuell wählen, freigeben und eine Bremsung starten, oder ein Prüfprogramm laufen lassen.</translation>
    </message>
</context>
<context>
    <name>EmptyState</name>
    <message>
        <source>No program is open</source>
        <translation>Kein Programm geöffnet</translation>
    </message>
    <message>
        <source>A program is a list of sequences: bedding, then for example a matrix of temperatures, speeds and pressures. Begin with a new one, change one that comes with rigctl, or drop a program file here.</source>
        <translation>Ein Programm ist eine Liste von Sequenzen: Einbremsen, dann zum Beispiel eine Matrix aus Temperaturen, Drehzahlen und Drücken. Neu beginnen, ein mitgeliefertes ändern oder eine Programmdatei hier ablegen.</translation>
    </message>
    <message>
        <source>New matrix of brakings</source>
        <translation>Neue Matrix von Bremsungen</translation>
    </message>
    <message>
        <source>A program with one sequence, to be changed</source>
        <translation>Ein Programm mit einer Sequenz, zum Ändern</translation>
    </message>
    <message>
        <source>Open a file …</source>
        <translation>Datei öffnen …</translation>
    </message>
    <message>
        <source>A program file of the window or the command line (Ctrl+O)</source>
        <translation>Eine Programmdatei des Fensters oder der Befehlszeile (Strg+O)</translation>
    </message>
    <message>
        <source>Recent</source>
        <translation>Zuletzt benutzt</translation>
    </message>
    <message>
        <source>Coming with rigctl</source>
        <translation>Mitgeliefert</translation>
    </message>
</context>
<context>
    <name>EventsTable</name>
    <message>
        <source>Squeal
Hz</source>
        <translation>Quietschen
Hz</translation>
    </message>
    <message>
        <source>Level
dB</source>
        <translation>Pegel
dB</translation>
    </message>
    <message>
        <source>Level A
dB(A)</source>
        <translation>Pegel A
dB(A)</translation>
    </message>
    <message>
        <source>Start
s</source>
        <translation>Beginn
s</translation>
    </message>
    <message>
        <source>Length
s</source>
        <translation>Dauer
s</translation>
    </message>
    <message>
        <source>Noise events; click one to see it in time</source>
        <translation>Geräuschereignisse; Klick zeigt eines in der Zeit</translation>
    </message>
    <message>
        <source>harmonic</source>
        <translation>Oberton</translation>
    </message>
</context>
<context>
    <name>ExportBar</name>
    <message>
        <source>Sound as recorded, 16 bit</source>
        <translation>Ton wie aufgezeichnet, 16 Bit</translation>
    </message>
    <message>
        <source>All channels as text, one file per sampling rate; events</source>
        <translation>Alle Kanäle als Text, eine Datei je Abtastrate; Ereignisse</translation>
    </message>
    <message>
        <source>Channels, set-points, results and events (version 5, also for Octave)</source>
        <translation>Kanäle, Sollwerte, Ergebnisse und Ereignisse (Version 5, auch für Octave)</translation>
    </message>
    <message>
        <source>A copy of the braking&apos;s file</source>
        <translation>Eine Kopie der Datei der Bremsung</translation>
    </message>
    <message>
        <source>Where the files are written; it is made if it does not exist</source>
        <translation>Wohin die Dateien kommen; wird angelegt, wenn es ihn nicht gibt</translation>
    </message>
    <message>
        <source>Browse…</source>
        <translation>Durchsuchen…</translation>
    </message>
    <message>
        <source>Choose the folder</source>
        <translation>Ordner wählen</translation>
    </message>
    <message>
        <source>Export</source>
        <translation>Exportieren</translation>
    </message>
    <message>
        <source>Write the files; nothing that exists is replaced</source>
        <translation>Die Dateien schreiben; nichts Vorhandenes wird ersetzt</translation>
    </message>
    <message>
        <source>Cancel</source>
        <translation>Abbrechen</translation>
    </message>
    <message>
        <source>Stop after the braking that is being written (Esc)</source>
        <translation>Nach der Bremsung aufhören, die gerade geschrieben wird (Esc)</translation>
    </message>
    <message>
        <source>Export braking {0}</source>
        <translation>Bremsung {0} exportieren</translation>
    </message>
    <message>
        <source>Export {0} brakings</source>
        <translation>{0} Bremsungen exportieren</translation>
    </message>
    <message>
        <source>Give a folder.</source>
        <translation>Einen Ordner angeben.</translation>
    </message>
    <message>
        <source>This is a file; give a folder.</source>
        <translation>Das ist eine Datei; einen Ordner angeben.</translation>
    </message>
    <message>
        <source>Choose at least one format.</source>
        <translation>Mindestens ein Format wählen.</translation>
    </message>
    <message>
        <source>Folder for the files</source>
        <translation>Ordner für die Dateien</translation>
    </message>
    <message>
        <source>{0} files written to {1}</source>
        <translation>{0} Dateien nach {1} geschrieben</translation>
    </message>
</context>
<context>
    <name>FactsForm</name>
    <message>
        <source>maker, type, serial number</source>
        <translation>Hersteller, Typ, Seriennummer</translation>
    </message>
    <message>
        <source>type, class, serial number, certificate</source>
        <translation>Typ, Klasse, Seriennummer, Zertifikat</translation>
    </message>
    <message>
        <source>days</source>
        <translation>Tage</translation>
    </message>
    <message>
        <source>Operator</source>
        <translation>Bearbeiter</translation>
    </message>
    <message>
        <source>Who calibrates; stands in the file</source>
        <translation>Wer kalibriert; steht in der Datei</translation>
    </message>
    <message>
        <source>Sensor</source>
        <translation>Sensor</translation>
    </message>
    <message>
        <source>The sensor that is calibrated</source>
        <translation>Der Sensor, der kalibriert wird</translation>
    </message>
    <message>
        <source>What it is compared with</source>
        <translation>Womit er verglichen wird</translation>
    </message>
    <message>
        <source>Valid for</source>
        <translation>Gültig für</translation>
    </message>
    <message>
        <source>After so many days it is due again</source>
        <translation>Nach so vielen Tagen ist er wieder fällig</translation>
    </message>
    <message>
        <source>Say who calibrates.</source>
        <translation>Angeben, wer kalibriert.</translation>
    </message>
</context>
<context>
    <name>FaultList</name>
    <message>
        <source>Click: go to the field</source>
        <translation>Klick: zum Feld</translation>
    </message>
    <message>
        <source>1 error</source>
        <translation>1 Fehler</translation>
    </message>
    <message>
        <source>{0} errors</source>
        <translation>{0} Fehler</translation>
    </message>
    <message>
        <source>1 warning</source>
        <translation>1 Warnung</translation>
    </message>
    <message>
        <source>{0} warnings</source>
        <translation>{0} Warnungen</translation>
    </message>
</context>
<context>
    <name>FigurePlot</name>
    <message>
        <source>Show all</source>
        <translation>Alles zeigen</translation>
    </message>
    <message>
        <source>{0} brakings; click again for the next</source>
        <translation>{0} Bremsungen; noch ein Klick für die nächste</translation>
    </message>
</context>
<context>
    <name>Figures</name>
    <message>
        <source>Estimated from heat and rates of the rig, good enough to plan a night</source>
        <translation>Geschätzt aus Wärme und Raten des Prüfstands, gut genug, um eine Nacht zu planen</translation>
    </message>
    <message>
        <source>Samples before compression; the disk is the one of the data folder</source>
        <translation>Abtastwerte vor dem Komprimieren; gemeint ist die Platte des Datenordners</translation>
    </message>
    <message>
        <source>about {0}</source>
        <translation>etwa {0}</translation>
    </message>
    <message>
        <source>▨&#xa0;{0} heating and cooling   ■&#xa0;{1}&#xa0;braking   □&#xa0;{2}&#xa0;other</source>
        <translation>▨ {0} Heizen und Kühlen   ■ {1} Bremsen   □ {2} Übriges</translation>
    </message>
    <message>
        <source>{0} of data</source>
        <translation>{0} Daten</translation>
    </message>
    <message>
        <source>, {0} of disk left</source>
        <translation>, {0} auf der Platte frei</translation>
    </message>
</context>
<context>
    <name>FiguresPane</name>
    <message>
        <source>Figures of the report; click a dot or a cell to open its braking</source>
        <translation>Grafiken des Berichts; Klick auf Punkt oder Feld öffnet die Bremsung</translation>
    </message>
    <message>
        <source>A second campaign beside the first, on the same scales</source>
        <translation>Eine zweite Kampagne daneben, in gleichen Maßstäben</translation>
    </message>
    <message>
        <source>&amp;Beside</source>
        <translation>Da&amp;neben</translation>
    </message>
    <message>
        <source>no other</source>
        <translation>keine</translation>
    </message>
    <message>
        <source>Frequency over pressure</source>
        <translation>Frequenz über Druck</translation>
    </message>
    <message>
        <source>Occurrence over pressure and temperature</source>
        <translation>Häufigkeit über Druck und Temperatur</translation>
    </message>
    <message>
        <source>Levels of squeal</source>
        <translation>Quietschpegel</translation>
    </message>
    <message>
        <source>Frequency over temperature</source>
        <translation>Frequenz über Temperatur</translation>
    </message>
    <message>
        <source>Friction over pressure and temperature</source>
        <translation>Reibwert über Druck und Temperatur</translation>
    </message>
    <message>
        <source>Friction over number</source>
        <translation>Reibwert über Nummer</translation>
    </message>
    <message>
        <source>Brake pressure [bar]</source>
        <translation>Bremsdruck [bar]</translation>
    </message>
    <message>
        <source>Disc temperature [°C]</source>
        <translation>Scheibentemperatur [°C]</translation>
    </message>
    <message>
        <source>Frequency [kHz]</source>
        <translation>Frequenz [kHz]</translation>
    </message>
    <message>
        <source>Mean coefficient of friction</source>
        <translation>Mittlerer Reibwert</translation>
    </message>
    <message>
        <source>Level of the loudest squeal [dB]</source>
        <translation>Pegel des lautesten Quietschens [dB]</translation>
    </message>
    <message>
        <source>Brakings that reach it [%]</source>
        <translation>Bremsungen, die ihn erreichen [%]</translation>
    </message>
    <message>
        <source>Number of the braking</source>
        <translation>Nummer der Bremsung</translation>
    </message>
    <message>
        <source>Number: mean µ. Dark: low, light: high.</source>
        <translation>Zahl: mittleres µ. Dunkel: niedrig, hell: hoch.</translation>
    </message>
    <message>
        <source>Number: level of the loudest squeal in dB, or squealing / all brakings. Blank: no squeal. Dark 60 dB … light 100 dB.</source>
        <translation>Zahl: Pegel des lautesten Quietschens in dB, oder quietschende / alle Bremsungen. Leer: kein Quietschen. Dunkel 60 dB … hell 100 dB.</translation>
    </message>
    <message>
        <source>Size and colour: level of the squeal, dark 60 dB … light 100 dB. Grey: no squeal.</source>
        <translation>Größe und Farbe: Quietschpegel, dunkel 60 dB … hell 100 dB. Grau: kein Quietschen.</translation>
    </message>
</context>
<context>
    <name>FilterBar</name>
    <message>
        <source>&amp;p</source>
        <translation>&amp;p</translation>
    </message>
    <message>
        <source>&amp;T</source>
        <translation>&amp;T</translation>
    </message>
    <message>
        <source>With or without squeal</source>
        <translation>Mit oder ohne Quietschen</translation>
    </message>
    <message>
        <source>Squeal or not</source>
        <translation>Quietschen: alle</translation>
    </message>
    <message>
        <source>With squeal</source>
        <translation>Mit Quietschen</translation>
    </message>
    <message>
        <source>Without squeal</source>
        <translation>Ohne Quietschen</translation>
    </message>
    <message>
        <source>What counts, what is excluded, incomplete or in the trash</source>
        <translation>Was zählt, was ausgeschlossen, unvollständig oder im Papierkorb ist</translation>
    </message>
    <message>
        <source>Any state</source>
        <translation>Jeder Zustand</translation>
    </message>
    <message>
        <source>What counts</source>
        <translation>Was zählt</translation>
    </message>
    <message>
        <source>Brakings with this tag</source>
        <translation>Bremsungen mit diesem Schlagwort</translation>
    </message>
    <message>
        <source>Any tag</source>
        <translation>Jedes Schlagwort</translation>
    </message>
    <message>
        <source>Words in notes (Ctrl+F)</source>
        <translation>Wörter in Notizen (Strg+F)</translation>
    </message>
    <message>
        <source>Words in note, reason, tags, sequence or role</source>
        <translation>Wörter in Notiz, Grund, Schlagwörtern, Sequenz oder Rolle</translation>
    </message>
    <message>
        <source>Show all</source>
        <translation>Alles zeigen</translation>
    </message>
    <message>
        <source>Remove all filters</source>
        <translation>Alle Filter entfernen</translation>
    </message>
    <message>
        <source>Show or hide the filters; hidden ones stay in force</source>
        <translation>Filter zeigen oder verbergen; verborgene gelten weiter</translation>
    </message>
    <message>
        <source>&amp;Filters ▾</source>
        <translation>&amp;Filter ▾</translation>
    </message>
    <message>
        <source>&amp;Filters ▸</source>
        <translation>&amp;Filter ▸</translation>
    </message>
</context>
<context>
    <name>HeatView</name>
    <message>
        <source>Emissivity by contact thermometer</source>
        <translation>Emissionsgrad mit Kontaktthermometer</translation>
    </message>
    <message>
        <source>Contact thermometer</source>
        <translation>Kontaktthermometer</translation>
    </message>
    <message>
        <source>&amp;Emissivity set</source>
        <translation>Emissionsgra&amp;d jetzt</translation>
    </message>
    <message>
        <source>As it is set at the pyrometer now</source>
        <translation>Wie er am Pyrometer jetzt eingestellt ist</translation>
    </message>
    <message>
        <source>&amp;Wavelength</source>
        <translation>&amp;Wellenlänge</translation>
    </message>
    <message>
        <source>Effective one; 10 µm for 8 to 14 µm</source>
        <translation>Die wirksame; 10 µm bei 8 bis 14 µm</translation>
    </message>
    <message>
        <source>Sur&amp;roundings</source>
        <translation>&amp;Umgebung</translation>
    </message>
    <message>
        <source>Temperature of what the disc reflects</source>
        <translation>Temperatur dessen, was sich in der Scheibe spiegelt</translation>
    </message>
    <message>
        <source>&amp;Contact reading</source>
        <translation>K&amp;ontaktwert</translation>
    </message>
    <message>
        <source>What it shows on the rub track, now</source>
        <translation>Was es jetzt auf der Reibspur anzeigt</translation>
    </message>
    <message>
        <source>Contact thermometer of the &amp;simulated rig</source>
        <translation>Kontaktthermometer des &amp;simulierten Prüfstands</translation>
    </message>
    <message>
        <source>True temperature of the rub surface meanwhile, from the fault laboratory</source>
        <translation>Derweil die wahre Temperatur der Reibfläche, aus dem Fehlerlabor</translation>
    </message>
    <message>
        <source>&amp;Take the pair</source>
        <translation>&amp;Paar aufnehmen</translation>
    </message>
    <message>
        <source>Mean of the pyrometer over 1 s, beside the contact reading</source>
        <translation>Mittel des Pyrometers über 1 s, neben dem Kontaktwert</translation>
    </message>
    <message>
        <source>Bring the disc to about 100 °C, let it stand, press the contact thermometer on the rub track, wait, type its reading, take the pair. A second pair at 200 °C or more shows errors.</source>
        <translation>Scheibe auf etwa 100 °C bringen, stehen lassen, Kontaktthermometer auf die Reibspur drücken, seinen Wert eintippen, Paar aufnehmen. Ein zweites Paar bei 200 °C oder mehr zeigt Fehler.</translation>
    </message>
    <message>
        <source>Contact</source>
        <translation>Kontakt</translation>
    </message>
    <message>
        <source>Pyrometer</source>
        <translation>Pyrometer</translation>
    </message>
    <message>
        <source>Difference</source>
        <translation>Differenz</translation>
    </message>
    <message>
        <source>After correction</source>
        <translation>Nach Korrektur</translation>
    </message>
    <message>
        <source>Remo&amp;ve the selected pair</source>
        <translation>Gewähltes Paar &amp;löschen</translation>
    </message>
    <message>
        <source>to be set at the &amp;pyrometer</source>
        <translation>am P&amp;yrometer einzustellen</translation>
    </message>
    <message>
        <source>corrected in the c&amp;hannel</source>
        <translation>im Kanal korr&amp;igiert</translation>
    </message>
    <message>
        <source>Exact; set the new emissivity there and in the rig file</source>
        <translation>Genau; den neuen Emissionsgrad dort und in der Prüfstandsdatei einstellen</translation>
    </message>
    <message>
        <source>A line over the range; the pyrometer keeps its setting</source>
        <translation>Eine Gerade über den Bereich; das Pyrometer behält seine Einstellung</translation>
    </message>
    <message>
        <source>Save cali&amp;bration</source>
        <translation>Kali&amp;brierung speichern</translation>
    </message>
    <message>
        <source>Pairs</source>
        <translation>Paare</translation>
    </message>
    <message>
        <source>Pyrometer {0}</source>
        <translation>Pyrometer {0}</translation>
    </message>
    <message>
        <source>The pyrometer has no valid reading.</source>
        <translation>Das Pyrometer hat keinen gültigen Wert.</translation>
    </message>
    <message>
        <source>No pair yet.</source>
        <translation>Noch kein Paar.</translation>
    </message>
    <message>
        <source>Emissivity {0}; in the channel: gain {1}, offset {2}, within {3} of it</source>
        <translation>Emissionsgrad {0}; im Kanal: Faktor {1}, Versatz {2}, auf {3} genau</translation>
    </message>
    <message>
        <source>Keep it; it holds from the next start of the rig</source>
        <translation>Behalten; gilt ab dem nächsten Start des Prüfstands</translation>
    </message>
    <message>
        <source>Pairs are needed that nothing speaks against</source>
        <translation>Es braucht Paare, gegen die nichts spricht</translation>
    </message>
</context>
<context>
    <name>InlineConfirm</name>
    <message>
        <source>Cancel</source>
        <translation>Abbrechen</translation>
    </message>
    <message>
        <source>Do nothing (Esc)</source>
        <translation>Nichts tun (Esc)</translation>
    </message>
</context>
<context>
    <name>JournalTab</name>
    <message>
        <source>Campaigns of the data folder, newest first</source>
        <translation>Kampagnen des Datenordners, neueste zuerst</translation>
    </message>
    <message>
        <source>search</source>
        <translation>Suchen</translation>
    </message>
    <message>
        <source>Rows with all these words (Ctrl+F)</source>
        <translation>Zeilen mit allen diesen Wörtern (Strg+F)</translation>
    </message>
    <message>
        <source>Process that wrote the record</source>
        <translation>Prozess, der den Eintrag schrieb</translation>
    </message>
    <message>
        <source>Kind of record</source>
        <translation>Art des Eintrags</translation>
    </message>
    <message>
        <source>&amp;Follow</source>
        <translation>Folg&amp;en</translation>
    </message>
    <message>
        <source>Show new records as they come</source>
        <translation>Neue Einträge zeigen, wie sie kommen</translation>
    </message>
    <message>
        <source>&amp;Check for gaps</source>
        <translation>Auf &amp;Lücken prüfen</translation>
    </message>
    <message>
        <source>Every process chains its records by hash: gaps and changes are found</source>
        <translation>Jeder Prozess verkettet seine Einträge mit Prüfsummen: Lücken und Änderungen fallen auf</translation>
    </message>
    <message>
        <source>Choose a record to see all of it.</source>
        <translation>Einen Eintrag wählen, um ihn ganz zu sehen.</translation>
    </message>
    <message>
        <source>{0} (running)</source>
        <translation>{0} (läuft)</translation>
    </message>
    <message>
        <source>No campaign in {0} yet: every run and every manual session writes a journal.</source>
        <translation>Noch keine Kampagne in {0}: jeder Lauf und jede manuelle Sitzung schreibt ein Journal.</translation>
    </message>
    <message>
        <source>all processes</source>
        <translation>alle Prozesse</translation>
    </message>
    <message>
        <source>all kinds</source>
        <translation>alle Arten</translation>
    </message>
    <message>
        <source>{0} of {1} records</source>
        <translation>{0} von {1} Einträgen</translation>
    </message>
    <message>
        <source>Checking …</source>
        <translation>Wird geprüft …</translation>
    </message>
    <message>
        <source>No gaps: every record is whole and in its place.</source>
        <translation>Keine Lücken: jeder Eintrag ist heil und an seinem Platz.</translation>
    </message>
</context>
<context>
    <name>JournalTable</name>
    <message>
        <source>Time</source>
        <translation>Zeit</translation>
    </message>
    <message>
        <source>Rig time (s)</source>
        <translation>Prüfstandszeit (s)</translation>
    </message>
    <message>
        <source>Process</source>
        <translation>Prozess</translation>
    </message>
    <message>
        <source>Kind</source>
        <translation>Art</translation>
    </message>
    <message>
        <source>What</source>
        <translation>Was</translation>
    </message>
</context>
<context>
    <name>KnobSlider</name>
    <message>
        <source>Reset</source>
        <extracomment>positions of a logarithmic slider on each side of the factor 1</extracomment>
        <translation>Rücksetzen</translation>
    </message>
    <message>
        <source>Back to the value of the brake file</source>
        <translation>Zurück auf den Wert der Bremsendatei</translation>
    </message>
    <message>
        <source>{0} to {1}{2}. Arrow keys: small steps, Page Up and Page Down: large ones</source>
        <translation>{0} bis {1}{2}. Pfeiltasten: kleine Schritte, Bild auf und ab: große</translation>
    </message>
    <message>
        <source>Type a value and press Enter</source>
        <translation>Wert eintippen und Enter drücken</translation>
    </message>
</context>
<context>
    <name>KnobTable</name>
    <message>
        <source>Parameter group</source>
        <translation>Parametergruppe</translation>
    </message>
    <message>
        <source>Factor</source>
        <translation>Faktor</translation>
    </message>
</context>
<context>
    <name>LaboratoryTab</name>
    <message>
        <source>Everything here happens to the simulated rig only, as it would in reality: trips are real trips of the watchdog, journaled and to be acknowledged. By command: rigctl laboratory.</source>
        <translation>Alles hier geschieht nur dem simulierten Prüfstand, wie in Wirklichkeit: Auslösungen sind echte Auslösungen des Wächters, kommen ins Journal und sind zu quittieren. Als Befehl: rigctl laboratory.</translation>
    </message>
    <message>
        <source>Hard-wired: torque off and pressure vented at once</source>
        <translation>Fest verdrahtet: Moment weg und Druck sofort abgelassen</translation>
    </message>
    <message>
        <source>The pressure stays when the relay opens</source>
        <translation>Der Druck bleibt, wenn das Relais öffnet</translation>
    </message>
    <message>
        <source>Safety chain and valves</source>
        <translation>Sicherheitskette und Ventile</translation>
    </message>
    <message>
        <source>none</source>
        <translation>keiner</translation>
    </message>
    <message>
        <source>Disc at</source>
        <translation>Scheibe auf</translation>
    </message>
    <message>
        <source>Set the disc to this temperature at once (Enter)</source>
        <translation>Scheibe sofort auf diese Temperatur setzen (Enter)</translation>
    </message>
    <message>
        <source>Lever puts</source>
        <translation>Hebel bringt</translation>
    </message>
    <message>
        <source>Torque on both sensors, at standstill (Enter)</source>
        <translation>Moment auf beide Sensoren, im Stillstand (Enter)</translation>
    </message>
    <message>
        <source>Calibrator</source>
        <translation>Kalibrator</translation>
    </message>
    <message>
        <source>On the microphone, 1 kHz</source>
        <translation>Auf dem Mikrofon, 1 kHz</translation>
    </message>
    <message>
        <source>Microphone off by</source>
        <translation>Mikrofon falsch um</translation>
    </message>
    <message>
        <source>Its sensitivity has drifted (Enter)</source>
        <translation>Seine Empfindlichkeit ist weggelaufen (Enter)</translation>
    </message>
    <message>
        <source>Plant and microphone</source>
        <translation>Strecke und Mikrofon</translation>
    </message>
    <message>
        <source>Brake pressure</source>
        <translation>Bremsdruck</translation>
    </message>
    <message>
        <source>Speed</source>
        <translation>Drehzahl</translation>
    </message>
    <message>
        <source>Torque</source>
        <translation>Moment</translation>
    </message>
    <message>
        <source>Disc temperature</source>
        <translation>Scheibentemperatur</translation>
    </message>
    <message>
        <source>Sensors</source>
        <translation>Sensoren</translation>
    </message>
    <message>
        <source>Do this to the sensor now</source>
        <translation>Dies dem Sensor jetzt antun</translation>
    </message>
    <message>
        <source>Look every second</source>
        <translation>Jede Sekunde nachsehen</translation>
    </message>
    <message>
        <source>Ask the rig what is in force</source>
        <translation>Den Prüfstand fragen, was in Kraft ist</translation>
    </message>
    <message>
        <source>Mend &amp;all</source>
        <translation>Alles &amp;beheben</translation>
    </message>
    <message>
        <source>End everything that is in force; the disc keeps its temperature</source>
        <translation>Alles beenden, was in Kraft ist; die Scheibe behält ihre Temperatur</translation>
    </message>
    <message>
        <source>In force</source>
        <translation>In Kraft</translation>
    </message>
    <message>
        <source>No simulated rig is connected.</source>
        <translation>Kein simulierter Prüfstand ist verbunden.</translation>
    </message>
    <message>
        <source>Nothing is disturbed.</source>
        <translation>Nichts ist gestört.</translation>
    </message>
    <message>
        <source>Truth behind the sensors: {0} 1/min, {1} bar, {2} N·m, {3} °C</source>
        <translation>Wahrheit hinter den Sensoren: {0} 1/min, {1} bar, {2} N·m, {3} °C</translation>
    </message>
    <message>
        <source>Press the &amp;emergency stop</source>
        <translation>Not-&amp;Halt drücken</translation>
    </message>
    <message>
        <source>Emergency stop is pressed: r&amp;elease it</source>
        <translation>Not-&amp;Halt ist gedrückt: entriegeln</translation>
    </message>
    <message>
        <source>Open the &amp;doors</source>
        <translation>&amp;Türen öffnen</translation>
    </message>
    <message>
        <source>&amp;Doors are open: close them</source>
        <translation>&amp;Türen sind offen: schließen</translation>
    </message>
    <message>
        <source>Let the &amp;vent valve stick</source>
        <translation>&amp;Entlüftungsventil klemmen lassen</translation>
    </message>
    <message>
        <source>&amp;Vent valve sticks: mend it</source>
        <translation>&amp;Entlüftungsventil klemmt: beheben</translation>
    </message>
</context>
<context>
    <name>LevelPlot</name>
    <message>
        <source>Sound level, fast (dB)</source>
        <translation>Schallpegel, Fast (dB)</translation>
    </message>
    <message>
        <source>Rig time (h:mm:ss)</source>
        <translation>Prüfstandszeit (h:mm:ss)</translation>
    </message>
</context>
<context>
    <name>LeverForm</name>
    <message>
        <source>Lever &amp;length</source>
        <translation>&amp;Hebellänge</translation>
    </message>
    <message>
        <source>From the axis of the disc to the weights</source>
        <translation>Von der Scheibenachse bis zu den Gewichten</translation>
    </message>
    <message>
        <source>&amp;Masses (kg)</source>
        <translation>&amp;Massen (kg)</translation>
    </message>
    <message>
        <source>What hangs on the lever, step by step, from light to heavy, with blanks between</source>
        <translation>Was am Hebel hängt, Schritt für Schritt, von leicht nach schwer, mit Leerzeichen dazwischen</translation>
    </message>
    <message>
        <source>&amp;Own moment</source>
        <translation>Eigenmomen&amp;t</translation>
    </message>
    <message>
        <source>Moment of the lever itself on the sensor; 0 when it is balanced</source>
        <translation>Moment des Hebels selbst am Sensor; 0, wenn er ausgewuchtet ist</translation>
    </message>
    <message>
        <source>&amp;Gravity g</source>
        <translation>Fallbes&amp;chl. g</translation>
    </message>
    <message>
        <source>At this place; Germany 9.807 to 9.815 m/s²</source>
        <translation>An diesem Ort; Deutschland 9.807 bis 9.815 m/s²</translation>
    </message>
    <message>
        <source>Give two masses at least: a line needs them.</source>
        <translation>Mindestens zwei Massen angeben: eine Gerade braucht sie.</translation>
    </message>
</context>
<context>
    <name>ListColumn</name>
    <message>
        <source>t
s</source>
        <translation>t
s</translation>
    </message>
    <message>
        <source>n1
1/min</source>
        <translation>n1
1/min</translation>
    </message>
    <message>
        <source>n2
1/min</source>
        <translation>n2
1/min</translation>
    </message>
    <message>
        <source>Fill a range …</source>
        <translation>Bereich füllen …</translation>
    </message>
    <message>
        <source>From … to … in equal steps</source>
        <translation>Von … bis … in gleichen Schritten</translation>
    </message>
    <message>
        <source>rig: {0:g} … {1:g} {2}</source>
        <translation>Prüfstand: {0:g} … {1:g} {2}</translation>
    </message>
    <message>
        <source>Type in the list, paste from a spreadsheet, or fill a range.</source>
        <translation>In die Liste tippen, aus einer Tabelle einfügen oder einen Bereich füllen.</translation>
    </message>
    <message>
        <source>1 profile</source>
        <translation>1 Verlauf</translation>
    </message>
    <message>
        <source>{0} profiles</source>
        <translation>{0} Verläufe</translation>
    </message>
    <message>
        <source>, {0} segments</source>
        <translation>, {0} Abschnitte</translation>
    </message>
    <message>
        <source>1 value</source>
        <translation>1 Wert</translation>
    </message>
    <message>
        <source>{0} values</source>
        <translation>{0} Werte</translation>
    </message>
    <message>
        <source>: {0} … {1} {2}</source>
        <translation>: {0} … {1} {2}</translation>
    </message>
</context>
<context>
    <name>Lists</name>
    <message>
        <source>Type a number and press Enter; several at once, as in 5 10 15, fill several rows. Paste from a spreadsheet with Ctrl+V.</source>
        <translation>Zahl tippen und Enter drücken; mehrere zugleich, wie 5 10 15, füllen mehrere Zeilen. Aus einer Tabelle mit Strg+V einfügen.</translation>
    </message>
    <message>
        <source>&amp;Temperatures</source>
        <translation>&amp;Temperaturen</translation>
    </message>
    <message>
        <source>Disc temperature at the start of each braking.</source>
        <translation>Scheibentemperatur zu Beginn jeder Bremsung.</translation>
    </message>
    <message>
        <source>&amp;Speed profiles</source>
        <translation>&amp;Drehzahlverläufe</translation>
    </message>
    <message>
        <source>Within t seconds from n1 to n2. A row marked + goes on with the profile above it (key +).</source>
        <translation>In t Sekunden von n1 nach n2. Eine mit + markierte Zeile setzt den Verlauf darüber fort (Taste +).</translation>
    </message>
    <message>
        <source>&amp;Pressures</source>
        <translation>&amp;Bremsdrücke</translation>
    </message>
    <message>
        <source>Working points of the brake pressure.</source>
        <translation>Arbeitspunkte des Bremsdrucks.</translation>
    </message>
    <message>
        <source>Not used: the conditioning is off.</source>
        <translation>Unbenutzt: die Konditionierung ist aus.</translation>
    </message>
</context>
<context>
    <name>LiveFeed</name>
    <message>
        <source>No limits in the live plots: {0}</source>
        <translation>Keine Grenzwerte in den Live-Bildern: {0}</translation>
    </message>
</context>
<context>
    <name>LivePlot</name>
    <message>
        <source>No signals yet. They appear when a rig is running.</source>
        <translation>Noch keine Signale. Sie erscheinen, wenn ein Prüfstand läuft.</translation>
    </message>
    <message>
        <source>This rig has no microphone.</source>
        <translation>Dieser Prüfstand hat kein Mikrofon.</translation>
    </message>
    <message>
        <source>No sound now. A simulated rig makes sound while a braking is recorded.</source>
        <translation>Gerade kein Ton. Ein simulierter Prüfstand macht Geräusche, während eine Bremsung aufgezeichnet wird.</translation>
    </message>
</context>
<context>
    <name>LiveSampler</name>
    <message>
        <source>The rig delivers no channel “{0}”.</source>
        <translation>Der Prüfstand liefert keinen Kanal „{0}“.</translation>
    </message>
    <message>
        <source>The rig delivers no samples yet: wait until it has started.</source>
        <translation>Der Prüfstand liefert noch keine Werte: warten, bis er gestartet ist.</translation>
    </message>
    <message>
        <source>The session has ended.</source>
        <translation>Die Sitzung ist beendet.</translation>
    </message>
    <message>
        <source>No samples of “{0}” come. Is the rig running and not paused?</source>
        <translation>Es kommen keine Werte von „{0}“. Läuft der Prüfstand, ohne Pause?</translation>
    </message>
</context>
<context>
    <name>LiveView</name>
    <message>
        <source>Picture copied</source>
        <translation>Bild kopiert</translation>
    </message>
    <message>
        <source>Live</source>
        <translation>Live</translation>
    </message>
    <message>
        <source>Pressure, torque, speed, temperature, µ</source>
        <translation>Druck, Moment, Drehzahl, Temperatur, µ</translation>
    </message>
    <message>
        <source>Sound pressure</source>
        <translation>Schalldruck</translation>
    </message>
    <message>
        <source>Spectrum</source>
        <translation>Spektrum</translation>
    </message>
    <message>
        <source>Spectrogram</source>
        <translation>Spektrogramm</translation>
    </message>
    <message>
        <source>Sound level</source>
        <translation>Schallpegel</translation>
    </message>
</context>
<context>
    <name>LocusPlot</name>
    <message>
        <source>Plane of eigenvalues</source>
        <extracomment>reach of a pick and of the read-out of a path, in steps of the grid the range of low-frequency brake squeal, as the ranking of modifications takes it</extracomment>
        <translation>Ebene der Eigenwerte</translation>
    </message>
    <message>
        <source>Real part [1/s]</source>
        <translation>Realteil [1/s]</translation>
    </message>
    <message>
        <source>Frequency [Hz]</source>
        <translation>Frequenz [Hz]</translation>
    </message>
    <message>
        <source>stable</source>
        <translation>stabil</translation>
    </message>
    <message>
        <source>unstable</source>
        <translation>instabil</translation>
    </message>
    <message>
        <source>Path at {0}: {1}, {2}</source>
        <translation>Bahn bei {0}: {1}, {2}</translation>
    </message>
</context>
<context>
    <name>LocusTab</name>
    <message>
        <source>&amp;All</source>
        <translation>&amp;Alle</translation>
    </message>
    <message>
        <source>All poles in view</source>
        <translation>Alle Pole im Bild</translation>
    </message>
    <message>
        <source>&amp;To 5 kHz</source>
        <translation>Bis 5 &amp;kHz</translation>
    </message>
    <message>
        <source>Poles of the squeal range in view</source>
        <translation>Pole des Quietschbereichs im Bild</translation>
    </message>
    <message>
        <source>Bou&amp;ndary</source>
        <translation>&amp;Grenze</translation>
    </message>
    <message>
        <source>A closer look at the modes that couple or become unstable first</source>
        <translation>Näher an die Moden, die zuerst koppeln oder instabil werden</translation>
    </message>
    <message>
        <source>View: all modes</source>
        <translation>Ansicht: alle Moden</translation>
    </message>
    <message>
        <source>View: squeal range</source>
        <translation>Ansicht: Quietschbereich</translation>
    </message>
    <message>
        <source>View: near the boundary</source>
        <translation>Ansicht: nahe der Grenze</translation>
    </message>
    <message>
        <source>Path: {0}</source>
        <translation>Bahn: {0}</translation>
    </message>
    <message>
        <source>No path: {0}</source>
        <translation>Keine Bahn: {0}</translation>
    </message>
    <message>
        <source>The selected mode lies outside the view. Press [To 5 kHz] or [All].</source>
        <translation>Die gewählte Mode liegt außerhalb der Ansicht. [Bis 5 kHz] oder [Alle] drücken.</translation>
    </message>
    <message>
        <source>Click a pole: the brake moves in that mode. × start of a path.</source>
        <translation>Pol anklicken: die Bremse schwingt darin. × Bahnanfang.</translation>
    </message>
</context>
<context>
    <name>MainWindow</name>
    <message>
        <source>Alt+{0}</source>
        <translation>Alt+{0}</translation>
    </message>
    <message>
        <source>Light / dark</source>
        <translation>Hell / dunkel</translation>
    </message>
    <message>
        <source>Change between the light and the dark look</source>
        <translation>Zwischen heller und dunkler Darstellung wechseln</translation>
    </message>
    <message>
        <source>Help (F1)</source>
        <translation>Hilfe (F1)</translation>
    </message>
    <message>
        <source> ({0} times)</source>
        <translation> ({0}-mal)</translation>
    </message>
    <message>
        <source>Help</source>
        <translation>Hilfe</translation>
    </message>
    <message>
        <source>No help for this page.</source>
        <translation>Keine Hilfe zu dieser Seite.</translation>
    </message>
    <message>
        <source>Alt+1 … Alt+6 pages · F12 software stop · Ctrl + and Ctrl − size of text · F1 this help</source>
        <translation>Alt+1 … Alt+6 Seiten · F12 Software-Stopp · Strg + und Strg − Schriftgröße · F1 diese Hilfe</translation>
    </message>
    <message>
        <source>Unsaved changes</source>
        <translation>Nicht gespeicherte Änderungen</translation>
    </message>
    <message>
        <source>Close without saving?</source>
        <translation>Schließen, ohne zu speichern?</translation>
    </message>
</context>
<context>
    <name>ManualPage</name>
    <message>
        <source>A program is running</source>
        <translation>Ein Programm läuft</translation>
    </message>
    <message>
        <source>Speed, pressure and temperature are set by the program; here you can look and listen. Pause, hold, skip or abort it on the page Run. STOP works from here, too.</source>
        <translation>Drehzahl, Druck und Temperatur stellt das Programm; hier nur zusehen und zuhören. Pause, Halten, Überspringen und Beenden auf der Seite Lauf. STOPP wirkt auch hier.</translation>
    </message>
    <message>
        <source>Show the &amp;run</source>
        <translation>Lauf a&amp;nsehen</translation>
    </message>
    <message>
        <source>Page Run: brakings, occurrence map, verbs (Alt+3)</source>
        <translation>Seite Lauf: Bremsungen, Quietschkarte, Befehle (Alt+3)</translation>
    </message>
    <message>
        <source>Mend speed or pressure above first.</source>
        <translation>Zuerst Drehzahl oder Druck oben berichtigen.</translation>
    </message>
    <message>
        <source>Type a pressure above 0 first.</source>
        <translation>Zuerst einen Druck über 0 eintippen.</translation>
    </message>
    <message>
        <source>with {0} bar ({1}) at {2} 1/min, as typed above</source>
        <translation>mit {0} bar ({1}) bei {2} 1/min, wie oben eingetippt</translation>
    </message>
    <message>
        <source>&lt;h3&gt;Manual&lt;/h3&gt;&lt;p&gt;Move motor and brake by hand and record single brakings. Connect to a rig, enable, type a set-point and press Enter. Blue is what is commanded. Limits stand beside each field.&lt;/p&gt;&lt;p&gt;&lt;b&gt;Space&lt;/b&gt; releases the pressure, wherever the cursor is (but in the comment)&lt;br&gt;&lt;b&gt;Enter&lt;/b&gt; applies the field, or presses the button with the focus&lt;br&gt;&lt;b&gt;Alt + underlined letter&lt;/b&gt; goes to a field or presses a button&lt;br&gt;&lt;b&gt;1 … 9&lt;/b&gt; noise rating of the present or last braking (when no field has the cursor)&lt;br&gt;&lt;b&gt;Esc&lt;/b&gt; cancels a question&lt;br&gt;&lt;b&gt;F12&lt;/b&gt; software stop&lt;/p&gt;&lt;p&gt;A course (ramp, sine, triangle, steps) ends by itself; its pressure is released then. Heating drags the brake; any other order ends it. A trip wants a reason before the rig can be enabled again.&lt;/p&gt;</source>
        <translation>&lt;h3&gt;Manuell&lt;/h3&gt;&lt;p&gt;Motor und Bremse von Hand fahren und einzelne Bremsungen aufzeichnen. Mit einem Prüfstand verbinden, freigeben, Sollwert tippen und Enter drücken. Blau ist, was befohlen ist. Grenzwerte stehen neben jedem Feld.&lt;/p&gt;&lt;p&gt;&lt;b&gt;Leertaste&lt;/b&gt; lässt den Druck ab, wo auch die Schreibmarke steht (nur nicht im Kommentar)&lt;br&gt;&lt;b&gt;Enter&lt;/b&gt; übernimmt das Feld oder drückt die Taste, die den Fokus hat&lt;br&gt;&lt;b&gt;Alt + unterstrichener Buchstabe&lt;/b&gt; springt in ein Feld oder drückt eine Taste&lt;br&gt;&lt;b&gt;1 … 9&lt;/b&gt; Geräuschnote der laufenden oder letzten Bremsung (wenn die Schreibmarke in keinem Feld steht)&lt;br&gt;&lt;b&gt;Esc&lt;/b&gt; bricht eine Frage ab&lt;br&gt;&lt;b&gt;F12&lt;/b&gt; Software-Stopp&lt;/p&gt;&lt;p&gt;Ein Verlauf (Rampe, Sinus, Dreieck, Stufen) endet von selbst; dann wird sein Druck abgelassen. Heizen lässt die Bremse schleifen; jeder andere Befehl beendet es. Nach einer Auslösung ist ein Grund anzugeben, bevor der Prüfstand wieder freigegeben werden kann.&lt;/p&gt;</translation>
    </message>
</context>
<context>
    <name>MapPlot</name>
    <message>
        <source>Stability map</source>
        <extracomment>room of a label on a contour line, as shares of the axes least span of the colours, Hz: a single mode is not spread over the whole scale</extracomment>
        <translation>Stabilitätskarte</translation>
    </message>
    <message>
        <source>Frequency of the unstable mode [Hz]</source>
        <translation>Frequenz der instabilen Mode [Hz]</translation>
    </message>
    <message>
        <source>{0}: stable, {1}</source>
        <translation>{0}: stabil, {1}</translation>
    </message>
    <message>
        <source>{0}: unstable at {1}, grows with {2}</source>
        <translation>{0}: instabil bei {1}, wächst mit {2}</translation>
    </message>
</context>
<context>
    <name>MapState</name>
    <message>
        <source>Coarse map…</source>
        <extracomment>points along each axis of the first and of the final map axes as they are at first: friction and pressure as rigs brake; factors around the file&apos;s value lane of longer work, shared with the other pages</extracomment>
        <translation>Grobe Karte…</translation>
    </message>
    <message>
        <source>Fine map: {0} points…</source>
        <translation>Feine Karte: {0} Punkte…</translation>
    </message>
</context>
<context>
    <name>MapTab</name>
    <message>
        <source>Measured squeal of this campaign is drawn into the map</source>
        <translation>Gemessenes Quietschen dieser Kampagne wird in die Karte gezeichnet</translation>
    </message>
    <message>
        <source>Cancel</source>
        <translation>Abbrechen</translation>
    </message>
    <message>
        <source>C&amp;ompute</source>
        <translation>Bere&amp;chnen</translation>
    </message>
    <message>
        <source>Keep the map that is there</source>
        <translation>Die vorhandene Karte behalten</translation>
    </message>
    <message>
        <source>Compute the map for the sliders&apos; values</source>
        <translation>Karte für die Werte der Regler berechnen</translation>
    </message>
    <message>
        <source>Open bra&amp;king</source>
        <translation>Brems&amp;ung öffnen</translation>
    </message>
    <message>
        <source>Show the braking of the measured point on the data page</source>
        <translation>Bremsung des Messpunkts auf der Seite Daten zeigen</translation>
    </message>
    <message>
        <source>View: whole map</source>
        <translation>Ansicht: ganze Karte</translation>
    </message>
    <message>
        <source>Across</source>
        <translation>Waagrecht</translation>
    </message>
    <message>
        <source>Upwards</source>
        <translation>Senkrecht</translation>
    </message>
    <message>
        <source>Measured s&amp;queal</source>
        <translation>Gemessenes &amp;Quietschen</translation>
    </message>
    <message>
        <source>Unstable over {0} % of the area. Click: the sliders jump there.</source>
        <translation>Instabil auf {0} % der Fläche. Klick: die Regler springen dorthin.</translation>
    </message>
    <message>
        <source>none</source>
        <translation>keine</translation>
    </message>
    <message>
        <source>Other folder…</source>
        <translation>Anderer Ordner…</translation>
    </message>
    <message>
        <source>Choose a campaign</source>
        <translation>Kampagne wählen</translation>
    </message>
    <message>
        <source>Choose a campaign to see its measured squeal over the predicted boundary.</source>
        <translation>Kampagne wählen zum Vergleich mit der Messung.</translation>
    </message>
    <message>
        <source>Measured squeal is drawn where the axes are friction and pressure.</source>
        <translation>Gemessenes Quietschen wird gezeichnet, wenn die Achsen Reibwert und Druck sind.</translation>
    </message>
    <message>
        <source>■ squeal measured: {0}, colour is its frequency   ○ braking without squeal: {1}</source>
        <translation>■ Quietschen gemessen: {0}, Farbe ist seine Frequenz   ○ Bremsung ohne Quietschen: {1}</translation>
    </message>
    <message>
        <source>   not drawn, no friction measured: {0}</source>
        <translation>   nicht gezeichnet, kein Reibwert gemessen: {0}</translation>
    </message>
    <message>
        <source>Both axes are the same slider. Choose another for one of them.</source>
        <translation>Beide Achsen sind derselbe Regler. Für eine einen anderen wählen.</translation>
    </message>
    <message>
        <source>{0}: the least value must lie below the largest.</source>
        <translation>{0}: der kleinste Wert muss unter dem größten liegen.</translation>
    </message>
</context>
<context>
    <name>MarksTable</name>
    <message>
        <source>Time
s</source>
        <translation>Zeit
s</translation>
    </message>
    <message>
        <source>What happened</source>
        <translation>Was geschah</translation>
    </message>
    <message>
        <source>Marks of the recording; click one to see it in time</source>
        <translation>Marken der Aufzeichnung; Klick zeigt eine in der Zeit</translation>
    </message>
</context>
<context>
    <name>ModeRows</name>
    <message>
        <source>No.</source>
        <extracomment>roles as plain numbers: comparing Qt&apos;s enumerations takes longer than all else</extracomment>
        <translation>Nr.</translation>
    </message>
    <message>
        <source>State</source>
        <translation>Zustand</translation>
    </message>
    <message>
        <source>Frequency
[Hz]</source>
        <translation>Frequenz
[Hz]</translation>
    </message>
    <message>
        <source>Damping
[%]</source>
        <translation>Dämpfung
[%]</translation>
    </message>
    <message>
        <source>Real part
[1/s]</source>
        <translation>Realteil
[1/s]</translation>
    </message>
    <message>
        <source>Damping ratio −Re / |λ|, percent of critical; negative: the mode grows</source>
        <translation>Dämpfungsgrad −Re / |λ|, in Prozent der kritischen Dämpfung; negativ: die Mode wächst</translation>
    </message>
</context>
<context>
    <name>ModeTable</name>
    <message>
        <source>Modes</source>
        <translation>Moden</translation>
    </message>
    <message>
        <source>Choose a mode: the brake below moves in it</source>
        <translation>Eine Mode wählen: die Bremse unten schwingt darin</translation>
    </message>
</context>
<context>
    <name>ModeView</name>
    <message>
        <source>Stop and start the motion (it is shown many times slower)</source>
        <extracomment>time of one period on screen, and between pictures lines of words, bodies or springs named at most, and the share from which they are named</extracomment>
        <translation>Bewegung anhalten und starten (sie läuft viele Male langsamer)</translation>
    </message>
    <message>
        <source>How far the motion is exaggerated</source>
        <translation>Wie stark die Bewegung überzeichnet ist</translation>
    </message>
    <message>
        <source>Phase within the period; moving it stops the motion</source>
        <translation>Phase in der Periode; Verschieben hält die Bewegung an</translation>
    </message>
    <message>
        <source>Amplitude</source>
        <translation>Amplitude</translation>
    </message>
    <message>
        <source>Phase</source>
        <translation>Phase</translation>
    </message>
    <message>
        <source>Moves: {0}</source>
        <translation>Bewegt: {0}</translation>
    </message>
    <message>
        <source>Strained: {0}</source>
        <translation>Beansprucht: {0}</translation>
    </message>
    <message>
        <source>Dampers add {0}, friction {1} to the real part</source>
        <translation>Dämpfer tragen {0}, Reibung {1} zum Realteil bei</translation>
    </message>
    <message>
        <source>Two modes nearly coincide: the shape is hardly its own.</source>
        <translation>Zwei Moden fallen fast zusammen: die Eigenform ist kaum ihre eigene.</translation>
    </message>
    <message>
        <source>Pause</source>
        <translation>Anhalten</translation>
    </message>
    <message>
        <source>Play</source>
        <translation>Abspielen</translation>
    </message>
</context>
<context>
    <name>ModelHeader</name>
    <message>
        <source>nothing</source>
        <translation>nichts</translation>
    </message>
    <message>
        <source>Brake file to be studied; choose it again to read it again</source>
        <translation>Bremsendatei, die untersucht wird; nochmals wählen liest sie neu ein</translation>
    </message>
    <message>
        <source>Second brake file: its poles are drawn as hollow diamonds, at the same µ, pressure and k</source>
        <translation>Zweite Bremsendatei: ihre Pole als hohle Rauten, bei gleichem µ, Druck und k</translation>
    </message>
    <message>
        <source>&amp;Brake</source>
        <translation>&amp;Bremse</translation>
    </message>
    <message>
        <source>Compare &amp;with</source>
        <translation>&amp;Vergleichen mit</translation>
    </message>
    <message>
        <source>No brake</source>
        <translation>Keine Bremse</translation>
    </message>
    <message>
        <source>Choose a brake file that can be read.</source>
        <translation>Eine lesbare Bremsendatei wählen.</translation>
    </message>
    <message>
        <source>{0}: {1}</source>
        <translation>{0}: {1}</translation>
    </message>
</context>
<context>
    <name>ModelPage</name>
    <message>
        <source>Root &amp;locus</source>
        <translation>&amp;Wurzelortskurve</translation>
    </message>
    <message>
        <source>Stability &amp;map</source>
        <translation>&amp;Stabilitätskarte</translation>
    </message>
    <message>
        <source>What h&amp;elps</source>
        <translation>Was &amp;hilft</translation>
    </message>
    <message>
        <source>&lt;b&gt;Model&lt;/b&gt;&lt;p&gt;Where does the brake model become unstable, in which mode, and what would help? Move a slider: poles move along their paths. Right of the axis a mode grows: squeal.&lt;/p&gt;&lt;p&gt;Click a pole or a row of the list, and the brake moves in that mode. The second tab shows the stable region with measured squeal in it, the third what to change.&lt;/p&gt;&lt;p&gt;Keys: arrows and Page Up/Down move a slider, Tab goes on, type a number for an exact value. Right click on a picture: copy or save it.&lt;/p&gt;</source>
        <translation>&lt;b&gt;Modell&lt;/b&gt;&lt;p&gt;Wo wird das Bremsenmodell instabil, in welcher Mode, und was würde helfen? Einen Regler schieben: die Pole wandern auf ihren Bahnen. Rechts der Achse wächst eine Mode: Quietschen.&lt;/p&gt;&lt;p&gt;Einen Pol oder eine Zeile der Liste anklicken, und die Bremse schwingt in dieser Mode. Die zweite Karteikarte zeigt das stabile Gebiet mit dem gemessenen Quietschen darin, die dritte, was zu ändern ist.&lt;/p&gt;&lt;p&gt;Tasten: Pfeile und Bild auf/ab schieben einen Regler, Tab geht weiter, eine getippte Zahl gilt genau. Rechtsklick auf ein Bild: kopieren oder speichern.&lt;/p&gt;</translation>
    </message>
</context>
<context>
    <name>NotesPanel</name>
    <message>
        <source>What was seen or heard; Enter saves</source>
        <translation>Was zu sehen oder zu hören war; Enter speichert</translation>
    </message>
    <message>
        <source>A note for this braking; the journal keeps who wrote it and when</source>
        <translation>Eine Notiz zu dieser Bremsung; das Journal hält fest, wer sie wann schrieb</translation>
    </message>
    <message>
        <source>Subjective noise rating of this braking</source>
        <translation>Subjektive Geräuschnote dieser Bremsung</translation>
    </message>
    <message>
        <source>1  nothing heard</source>
        <translation>1  nichts gehört</translation>
    </message>
    <message>
        <source>5  clearly heard</source>
        <translation>5  deutlich gehört</translation>
    </message>
    <message>
        <source>9  unbearable</source>
        <translation>9  unerträglich</translation>
    </message>
    <message>
        <source>not rated</source>
        <translation>ohne Note</translation>
    </message>
    <message>
        <source>Ta&amp;gs</source>
        <translation>&amp;Schlagwörter</translation>
    </message>
    <message>
        <source>N&amp;ote</source>
        <translation>&amp;Notiz</translation>
    </message>
    <message>
        <source>Ra&amp;ting</source>
        <translation>Geräuschnot&amp;e</translation>
    </message>
    <message>
        <source>Said then</source>
        <translation>Damals notiert</translation>
    </message>
</context>
<context>
    <name>OccurrenceView</name>
    <message>
        <source>Click a cell: its loudest braking opens on the Data page. Right click: copy, save.</source>
        <translation>Ein Feld anklicken: seine lauteste Bremsung öffnet sich auf der Seite Daten. Rechtsklick: kopieren, speichern.</translation>
    </message>
    <message>
        <source>Brake pressure (bar)</source>
        <translation>Bremsdruck (bar)</translation>
    </message>
    <message>
        <source>Disc temperature (°C)</source>
        <translation>Scheibentemperatur (°C)</translation>
    </message>
    <message>
        <source>Squeal over pressure and temperature: {0} of {1}</source>
        <translation>Quietschen über Druck und Temperatur: {0} von {1}</translation>
    </message>
    <message>
        <source>{0} bar, {1} °C: </source>
        <translation>{0} bar, {1} °C: </translation>
    </message>
    <message>
        <source>squeal in {0} of {1}, up to {2} dB</source>
        <translation>Quietschen bei {0} von {1}, bis {2} dB</translation>
    </message>
    <message>
        <source>no squeal in {0}</source>
        <translation>kein Quietschen bei {0}</translation>
    </message>
    <message>
        <source>to come</source>
        <translation>steht noch aus</translation>
    </message>
</context>
<context>
    <name>OrdersTable</name>
    <message>
        <source>Close</source>
        <translation>Schließen</translation>
    </message>
    <message>
        <source>Hide the other orders</source>
        <translation>Die anderen Folgen verbergen</translation>
    </message>
    <message>
        <source>The whole program would take, with this sequence in the order</source>
        <translation>So lange dauert das ganze Programm mit dieser Sequenz in der Folge</translation>
    </message>
    <message>
        <source>{0} heating and cooling</source>
        <translation>{0} Temperieren</translation>
    </message>
    <message>
        <source>Used</source>
        <translation>Benutzt</translation>
    </message>
    <message>
        <source>Use</source>
        <translation>Nehmen</translation>
    </message>
    <message>
        <source>Run the loops of this sequence in this order</source>
        <translation>Die Schleifen dieser Sequenz in dieser Folge abarbeiten</translation>
    </message>
</context>
<context>
    <name>Parts</name>
    <message>
        <source>Braking</source>
        <translation>Bremsung</translation>
    </message>
    <message>
        <source>Figures</source>
        <translation>Grafiken</translation>
    </message>
    <message>
        <source>Comparison</source>
        <translation>Vergleich</translation>
    </message>
    <message>
        <source>Large</source>
        <translation>Groß</translation>
    </message>
    <message>
        <source>Hide list and table (F11); Esc brings them back</source>
        <translation>Liste und Tabelle verbergen (F11); Esc holt sie zurück</translation>
    </message>
</context>
<context>
    <name>PictureMenu</name>
    <message>
        <source>Copy picture</source>
        <translation>Bild kopieren</translation>
    </message>
    <message>
        <source>Save picture…</source>
        <translation>Bild speichern…</translation>
    </message>
    <message>
        <source>Picture copied</source>
        <translation>Bild kopiert</translation>
    </message>
    <message>
        <source>Save picture</source>
        <translation>Bild speichern</translation>
    </message>
    <message>
        <source>Picture (*.png)</source>
        <translation>Bild (*.png)</translation>
    </message>
</context>
<context>
    <name>PlotTools</name>
    <message>
        <source>&amp;Follow</source>
        <translation>Folg&amp;en</translation>
    </message>
    <message>
        <source>Newest data at the right, automatic ranges (Home, or double click)</source>
        <translation>Neueste Daten rechts, Bereiche automatisch (Pos1 oder Doppelklick)</translation>
    </message>
    <message>
        <source>Free&amp;ze</source>
        <translation>E&amp;infrieren</translation>
    </message>
    <message>
        <source>Hold the picture. Recording goes on.</source>
        <translation>Bild festhalten. Die Aufzeichnung geht weiter.</translation>
    </message>
    <message>
        <source>&amp;Cursors</source>
        <translation>Curs&amp;or</translation>
    </message>
    <message>
        <source>Two cursors, to be dragged, and their difference</source>
        <translation>Zwei Cursor zum Ziehen und ihre Differenz</translation>
    </message>
    <message>
        <source>Time that is shown while following</source>
        <translation>Gezeigte Zeitspanne beim Folgen</translation>
    </message>
    <message>
        <source>Sho&amp;w</source>
        <translation>&amp;Zeigen</translation>
    </message>
    <message>
        <source>Which plots and channels are shown</source>
        <translation>Welche Bilder und Kanäle gezeigt werden</translation>
    </message>
    <message>
        <source>&amp;Picture</source>
        <translation>Bi&amp;ld</translation>
    </message>
    <message>
        <source>Copy or save all plots; for a single one, right click on it</source>
        <translation>Alle Bilder kopieren oder speichern; ein einzelnes mit Rechtsklick darauf</translation>
    </message>
    <message>
        <source>Copy</source>
        <translation>Kopieren</translation>
    </message>
    <message>
        <source>Save…</source>
        <translation>Speichern…</translation>
    </message>
    <message>
        <source>❚❚ FROZEN at {0} of rig time. Recording goes on. Follow shows the present.</source>
        <translation>❚❚ EINGEFROREN bei Prüfstandszeit {0}. Die Aufzeichnung geht weiter. Folgen zeigt die Gegenwart.</translation>
    </message>
    <message>
        <source>Follow</source>
        <translation>Folgen</translation>
    </message>
    <message>
        <source>Freeze</source>
        <translation>Einfrieren</translation>
    </message>
    <message>
        <source>Cursors</source>
        <translation>Cursor</translation>
    </message>
    <message>
        <source>Copy picture</source>
        <translation>Bild kopieren</translation>
    </message>
    <message>
        <source>Save picture…</source>
        <translation>Bild speichern…</translation>
    </message>
</context>
<context>
    <name>PressureBox</name>
    <message>
        <source>Brake</source>
        <translation>Bremse</translation>
    </message>
    <message>
        <source>Course of the pressure over time</source>
        <translation>Verlauf des Drucks über der Zeit</translation>
    </message>
    <message>
        <source>constant</source>
        <translation>konstant</translation>
    </message>
    <message>
        <source>ramp</source>
        <translation>Rampe</translation>
    </message>
    <message>
        <source>sine</source>
        <translation>Sinus</translation>
    </message>
    <message>
        <source>triangle</source>
        <translation>Dreieck</translation>
    </message>
    <message>
        <source>steps</source>
        <translation>Stufen</translation>
    </message>
    <message>
        <source>Offsets from the pressure in bar, separated by blanks; each for an equal share of the time</source>
        <translation>Abstände vom Druck in bar, mit Leerzeichen getrennt; jeder für einen gleichen Teil der Zeit</translation>
    </message>
    <message>
        <source>P&amp;ressure</source>
        <translation>Dru&amp;ck</translation>
    </message>
    <message>
        <source>From</source>
        <translation>Von</translation>
    </message>
    <message>
        <source>To</source>
        <translation>Bis</translation>
    </message>
    <message>
        <source>Amplitude</source>
        <translation>Amplitude</translation>
    </message>
    <message>
        <source>Frequency</source>
        <translation>Frequenz</translation>
    </message>
    <message>
        <source>Steps</source>
        <translation>Stufen</translation>
    </message>
    <message>
        <source>Time</source>
        <translation>Zeit</translation>
    </message>
    <message>
        <source>Pressure, or the mean of a course. Enter applies; blue is commanded.</source>
        <translation>Druck, oder Mittelwert eines Verlaufs. Enter übernimmt; blau ist befohlen.</translation>
    </message>
    <message>
        <source>Pressure at the beginning of the ramp</source>
        <translation>Druck am Anfang der Rampe</translation>
    </message>
    <message>
        <source>Pressure at the end of the ramp</source>
        <translation>Druck am Ende der Rampe</translation>
    </message>
    <message>
        <source>How far the pressure swings around its mean</source>
        <translation>Wie weit der Druck um seinen Mittelwert schwingt</translation>
    </message>
    <message>
        <source>Swings per second</source>
        <translation>Schwingungen je Sekunde</translation>
    </message>
    <message>
        <source>How long the course takes; the pressure is released after it</source>
        <translation>Wie lange der Verlauf dauert; danach wird der Druck abgelassen</translation>
    </message>
    <message>
        <source>C&amp;ourse</source>
        <translation>&amp;Verlauf</translation>
    </message>
    <message>
        <source>Set-points over time; dashed: the rig&apos;s limit</source>
        <translation>Sollwerte über der Zeit; gestrichelt: Grenze des Prüfstands</translation>
    </message>
    <message>
        <source>App&amp;ly pressure</source>
        <translation>Druck anle&amp;gen</translation>
    </message>
    <message>
        <source>Steps are numbers separated by blanks, e.g. 0 5 10.</source>
        <translation>Stufen sind Zahlen mit Leerzeichen dazwischen, z. B. 0 5 10.</translation>
    </message>
    <message>
        <source>Apply the brake with this pressure (Enter)</source>
        <translation>Die Bremse mit diesem Druck anlegen (Enter)</translation>
    </message>
    <message>
        <source>Mend the entry first.</source>
        <translation>Zuerst die Eingabe berichtigen.</translation>
    </message>
</context>
<context>
    <name>PressureSection</name>
    <message>
        <source>&amp;Course</source>
        <translation>&amp;Verlauf</translation>
    </message>
    <message>
        <source>The pressure swings around the working point from the list of pressures.</source>
        <translation>Der Druck schwingt um den Arbeitspunkt aus der Liste der Drücke.</translation>
    </message>
    <message>
        <source>&amp;Amplitude</source>
        <translation>&amp;Amplitude</translation>
    </message>
    <message>
        <source>The pressure stays between working point − amplitude and working point + amplitude.</source>
        <translation>Der Druck bleibt zwischen Arbeitspunkt − Amplitude und Arbeitspunkt + Amplitude.</translation>
    </message>
    <message>
        <source>&amp;Direction</source>
        <translation>R&amp;ichtung</translation>
    </message>
    <message>
        <source>rising</source>
        <translation>steigend</translation>
    </message>
    <message>
        <source>falling</source>
        <translation>fallend</translation>
    </message>
    <message>
        <source>A rising ramp begins at working point − amplitude.</source>
        <translation>Eine steigende Rampe beginnt bei Arbeitspunkt − Amplitude.</translation>
    </message>
    <message>
        <source>&amp;Frequency</source>
        <translation>&amp;Frequenz</translation>
    </message>
    <message>
        <source>Swings per second</source>
        <translation>Schwingungen je Sekunde</translation>
    </message>
    <message>
        <source>&amp;Steps</source>
        <translation>&amp;Stufen</translation>
    </message>
    <message>
        <source>Offsets from the working point in turn, each for an equal share of the braking: 0 5 −3</source>
        <translation>Abstände vom Arbeitspunkt der Reihe nach, jeder für einen gleichen Teil der Bremsung: 0 5 −3</translation>
    </message>
    <message>
        <source>&amp;Rise time</source>
        <translation>Anstiegs&amp;zeit</translation>
    </message>
    <message>
        <source>The pressure rises in a straight line from zero in this time; 0: as fast as the rig can.</source>
        <translation>In dieser Zeit steigt der Druck geradlinig von null; 0: so schnell der Prüfstand kann.</translation>
    </message>
    <message>
        <source>Pressure over the time of a braking; dashed: most the rig can do</source>
        <translation>Druck über der Zeit einer Bremsung; gestrichelt: das Höchste, was der Prüfstand kann</translation>
    </message>
    <message>
        <source>Drawn for the highest working point, {0:g} bar, over {1:g} s</source>
        <translation>Gezeichnet für den höchsten Arbeitspunkt, {0:g} bar, über {1:g} s</translation>
    </message>
    <message>
        <source>No drawing: a field above is wrong.</source>
        <translation>Keine Zeichnung: ein Feld oben ist falsch.</translation>
    </message>
    <message>
        <source>Working point {0:g} bar, drawn over 12 s</source>
        <translation>Arbeitspunkt {0:g} bar, gezeichnet über 12 s</translation>
    </message>
</context>
<context>
    <name>Procedure</name>
    <message>
        <source>← All calibrations</source>
        <translation>← Alle Kalibrierungen</translation>
    </message>
    <message>
        <source>Leave this procedure; what was read and not saved is lost (Esc)</source>
        <translation>Vorgang verlassen; was abgelesen und nicht gespeichert ist, geht verloren (Esc)</translation>
    </message>
    <message>
        <source>Not saved: {0}</source>
        <translation>Nicht gespeichert: {0}</translation>
    </message>
    <message>
        <source>Saved as {0}; it holds from the next start of the rig</source>
        <translation>Gespeichert als {0}; gilt ab dem nächsten Start des Prüfstands</translation>
    </message>
</context>
<context>
    <name>ProgramBar</name>
    <message>
        <source>New</source>
        <translation>Neu</translation>
    </message>
    <message>
        <source>A new program (Ctrl+N)</source>
        <translation>Ein neues Programm (Strg+N)</translation>
    </message>
    <message>
        <source>Open …</source>
        <translation>Öffnen …</translation>
    </message>
    <message>
        <source>A program file (Ctrl+O)</source>
        <translation>Eine Programmdatei (Strg+O)</translation>
    </message>
    <message>
        <source>Recent</source>
        <translation>Zuletzt benutzt</translation>
    </message>
    <message>
        <source>Programs opened or saved last</source>
        <translation>Zuletzt geöffnete oder gespeicherte Programme</translation>
    </message>
    <message>
        <source>Save</source>
        <translation>Speichern</translation>
    </message>
    <message>
        <source>To the open file (Ctrl+S)</source>
        <translation>In die geöffnete Datei (Strg+S)</translation>
    </message>
    <message>
        <source>Save as …</source>
        <translation>Speichern als …</translation>
    </message>
    <message>
        <source>Under another name (Ctrl+Shift+S)</source>
        <translation>Unter anderem Namen (Strg+Umschalt+S)</translation>
    </message>
    <message>
        <source>Undo</source>
        <translation>Rückgängig</translation>
    </message>
    <message>
        <source>Take back the last change (Ctrl+Z)</source>
        <translation>Die letzte Änderung zurücknehmen (Strg+Z)</translation>
    </message>
    <message>
        <source>Redo</source>
        <translation>Wiederherstellen</translation>
    </message>
    <message>
        <source>Do it again (Ctrl+Y)</source>
        <translation>Nochmals ausführen (Strg+Y)</translation>
    </message>
    <message>
        <source>●  {0}, not saved</source>
        <translation>●  {0}, nicht gespeichert</translation>
    </message>
    <message>
        <source>●  not saved yet</source>
        <translation>●  noch nicht gespeichert</translation>
    </message>
</context>
<context>
    <name>ProgramFiles</name>
    <message>
        <source>“{0}” has changes that are not saved.</source>
        <translation>„{0}“ hat nicht gespeicherte Änderungen.</translation>
    </message>
    <message>
        <source>Save</source>
        <translation>Speichern</translation>
    </message>
    <message>
        <source>Discard</source>
        <translation>Verwerfen</translation>
    </message>
    <message>
        <source>Keep editing</source>
        <translation>Weiter bearbeiten</translation>
    </message>
    <message>
        <source>Open a program</source>
        <translation>Programm öffnen</translation>
    </message>
    <message>
        <source>Programs (*.toml)</source>
        <translation>Programme (*.toml)</translation>
    </message>
    <message>
        <source>Not opened.</source>
        <translation>Nicht geöffnet.</translation>
    </message>
    <message>
        <source>{0} was changed by somebody else since it was opened. Saving here overwrites that.</source>
        <translation>{0} wurde seit dem Öffnen von jemand anderem geändert. Speichern überschreibt das.</translation>
    </message>
    <message>
        <source>{0} has comments, written by hand. Saving here removes them.</source>
        <translation>{0} enthält von Hand geschriebene Kommentare. Speichern entfernt sie.</translation>
    </message>
    <message>
        <source>Save as …</source>
        <translation>Speichern als …</translation>
    </message>
    <message>
        <source>Overwrite</source>
        <translation>Überschreiben</translation>
    </message>
    <message>
        <source>Cancel</source>
        <translation>Abbrechen</translation>
    </message>
    <message>
        <source>Save the program</source>
        <translation>Programm speichern</translation>
    </message>
    <message>
        <source>Not saved: the marked fields must be right first.</source>
        <translation>Nicht gespeichert: zuerst die markierten Felder berichtigen.</translation>
    </message>
    <message>
        <source>Saved as {0}</source>
        <translation>Gespeichert als {0}</translation>
    </message>
    <message>
        <source>Not saved.</source>
        <translation>Nicht gespeichert.</translation>
    </message>
    <message>
        <source>Close</source>
        <translation>Schließen</translation>
    </message>
</context>
<context>
    <name>ProgramList</name>
    <message>
        <source>Name of the program; campaigns are called after it</source>
        <translation>Name des Programms; Kampagnen heißen danach</translation>
    </message>
    <message>
        <source>What the program is for, for those who find the data later</source>
        <translation>Wozu das Programm dient, für alle, die die Daten später finden</translation>
    </message>
    <message>
        <source>What is it for?</source>
        <translation>Wozu dient es?</translation>
    </message>
    <message>
        <source>The sequences run from top to bottom. Tick: it is run. Drag, or Alt with the arrow keys: move.</source>
        <translation>Die Sequenzen laufen von oben nach unten. Haken: sie läuft. Ziehen oder Alt mit Pfeiltasten: verschieben.</translation>
    </message>
    <message>
        <source>Add</source>
        <translation>Hinzufügen</translation>
    </message>
    <message>
        <source>Matrix of brakings</source>
        <translation>Matrix von Bremsungen</translation>
    </message>
    <message>
        <source>Bedding</source>
        <translation>Einbremsen</translation>
    </message>
    <message>
        <source>Stop brakings</source>
        <translation>Stoppbremsungen</translation>
    </message>
    <message>
        <source>Copy</source>
        <translation>Kopieren</translation>
    </message>
    <message>
        <source>Remove</source>
        <translation>Entfernen</translation>
    </message>
    <message>
        <source>▲ Up</source>
        <translation>▲ Hoch</translation>
    </message>
    <message>
        <source>▼ Down</source>
        <translation>▼ Runter</translation>
    </message>
    <message>
        <source>Run this sequence earlier (Alt+Up)</source>
        <translation>Diese Sequenz früher abarbeiten (Alt+Auf)</translation>
    </message>
    <message>
        <source>Run this sequence later (Alt+Down)</source>
        <translation>Diese Sequenz später abarbeiten (Alt+Ab)</translation>
    </message>
    <message>
        <source>Add a sequence behind this one</source>
        <translation>Eine Sequenz hinter dieser einfügen</translation>
    </message>
    <message>
        <source>A copy of this sequence behind it</source>
        <translation>Eine Kopie dieser Sequenz dahinter</translation>
    </message>
    <message>
        <source>Remove this sequence (Del); Ctrl+Z brings it back</source>
        <translation>Diese Sequenz entfernen (Entf); Strg+Z holt sie zurück</translation>
    </message>
    <message>
        <source>Program</source>
        <translation>Programm</translation>
    </message>
    <message>
        <source>Sequences</source>
        <translation>Sequenzen</translation>
    </message>
    <message>
        <source>off</source>
        <translation>aus</translation>
    </message>
    <message>
        <source>✕ see the fields</source>
        <translation>✕ siehe Felder</translation>
    </message>
    <message>
        <source>(no name)</source>
        <translation>(ohne Namen)</translation>
    </message>
</context>
<context>
    <name>RangeFiller</name>
    <message>
        <source>step</source>
        <translation>Schritt</translation>
    </message>
    <message>
        <source>count</source>
        <translation>Anzahl</translation>
    </message>
    <message>
        <source>Distance of the values, or how many there are; both ends belong to them</source>
        <translation>Abstand der Werte, oder wie viele es sind; beide Enden gehören dazu</translation>
    </message>
    <message>
        <source>Fill the list</source>
        <translation>Liste füllen</translation>
    </message>
    <message>
        <source>Replace the list by this range</source>
        <translation>Die Liste durch diesen Bereich ersetzen</translation>
    </message>
    <message>
        <source>First value</source>
        <translation>Erster Wert</translation>
    </message>
    <message>
        <source>Last value; smaller than the first for a falling range</source>
        <translation>Letzter Wert; kleiner als der erste für einen fallenden Bereich</translation>
    </message>
    <message>
        <source>Distance, or number of values</source>
        <translation>Abstand oder Anzahl der Werte</translation>
    </message>
    <message>
        <source>from</source>
        <translation>von</translation>
    </message>
    <message>
        <source>to</source>
        <translation>bis</translation>
    </message>
    <message>
        <source>How long each braking lasts</source>
        <translation>Wie lange jede Bremsung dauert</translation>
    </message>
    <message>
        <source>each for, s</source>
        <translation>je, s</translation>
    </message>
    <message>
        <source>Enter three numbers, for example from 2 to 30 step 2.</source>
        <translation>Drei Zahlen eingeben, zum Beispiel von 2 bis 30 Schritt 2.</translation>
    </message>
</context>
<context>
    <name>RankingRows</name>
    <message>
        <source>Verdict</source>
        <extracomment>role of a number that is drawn as a bar: share of the largest in its column, −1…1</extracomment>
        <translation>Urteil</translation>
    </message>
    <message>
        <source>Modification</source>
        <translation>Änderung</translation>
    </message>
    <message>
        <source>Gain
[1/s]</source>
        <translation>Gewinn
[1/s]</translation>
    </message>
    <message>
        <source>Onset
[bar]</source>
        <translation>Einsetzen
[bar]</translation>
    </message>
    <message>
        <source>Worst
rise [%]</source>
        <translation>Schlimmster
Anstieg [%]</translation>
    </message>
    <message>
        <source>of mode
at [Hz]</source>
        <translation>der Mode
bei [Hz]</translation>
    </message>
</context>
<context>
    <name>RankingTab</name>
    <message>
        <source>By how much every group is changed</source>
        <translation>Um wie viel jede Gruppe geändert wird</translation>
    </message>
    <message>
        <source>Only what &amp;helps</source>
        <translation>Nur was hil&amp;ft</translation>
    </message>
    <message>
        <source>Ran&amp;k</source>
        <translation>Rangliste b&amp;ilden</translation>
    </message>
    <message>
        <source>Rank all modifications at the sliders&apos; values</source>
        <translation>Alle Änderungen bei den Werten der Regler bewerten</translation>
    </message>
    <message>
        <source>The sliders have moved since.</source>
        <translation>Die Regler wurden seither bewegt.</translation>
    </message>
    <message>
        <source>Ranking…</source>
        <translation>Rangliste wird gebildet…</translation>
    </message>
    <message>
        <source>Cancel</source>
        <translation>Abbrechen</translation>
    </message>
    <message>
        <source>Keep the ranking that is there</source>
        <translation>Die vorhandene Rangliste behalten</translation>
    </message>
    <message>
        <source>A&amp;pply to the sliders</source>
        <translation>Auf Regler über&amp;tragen</translation>
    </message>
    <message>
        <source>The modification goes on top of what the sliders say (Enter)</source>
        <translation>Die Änderung kommt zu dem hinzu, was die Regler sagen (Enter)</translation>
    </message>
    <message>
        <source>&amp;Take back</source>
        <translation>&amp;Zurücknehmen</translation>
    </message>
    <message>
        <source>Sliders as they were before the modification</source>
        <translation>Regler wie vor der Änderung</translation>
    </message>
    <message>
        <source>Sa&amp;ve table…</source>
        <translation>Tabe&amp;lle speichern…</translation>
    </message>
    <message>
        <source>The whole ranking as CSV</source>
        <translation>Die ganze Rangliste als CSV</translation>
    </message>
    <message>
        <source>Save p&amp;icture…</source>
        <translation>Bil&amp;d speichern…</translation>
    </message>
    <message>
        <source>The best modifications as a figure, PNG or SVG</source>
        <translation>Die besten Änderungen als Bild, PNG oder SVG</translation>
    </message>
    <message>
        <source>Change every gro&amp;up by</source>
        <translation>Jede Gru&amp;ppe ändern um</translation>
    </message>
    <message>
        <source>Nothing helps at this step. Try a larger one.</source>
        <translation>Bei diesem Schritt hilft nichts. Einen größeren versuchen.</translation>
    </message>
    <message>
        <source>Every parameter group is changed a little, up and down; what lowers the real parts wins.</source>
        <translation>Jede Parametergruppe wird ein wenig geändert, nach oben und unten; was die Realteile senkt, gewinnt.</translation>
    </message>
    <message>
        <source>Save table</source>
        <translation>Tabelle speichern</translation>
    </message>
    <message>
        <source>Table (*.csv)</source>
        <translation>Tabelle (*.csv)</translation>
    </message>
    <message>
        <source>Picture (*.png *.svg)</source>
        <translation>Bild (*.png *.svg)</translation>
    </message>
    <message>
        <source>Save picture</source>
        <translation>Bild speichern</translation>
    </message>
    <message>
        <source>Saved as {0}</source>
        <translation>Gespeichert als {0}</translation>
    </message>
</context>
<context>
    <name>RankingTable</name>
    <message>
        <source>Ranking of modifications</source>
        <translation>Rangliste der Änderungen</translation>
    </message>
</context>
<context>
    <name>RatingRow</name>
    <message>
        <source>1: nothing heard</source>
        <translation>1: nichts gehört</translation>
    </message>
    <message>
        <source>5: clearly heard</source>
        <translation>5: deutlich gehört</translation>
    </message>
    <message>
        <source>9: unbearable</source>
        <translation>9: unerträglich</translation>
    </message>
    <message>
        <source>Noise rating; the number keys do the same</source>
        <translation>Geräuschnote; die Zifferntasten tun dasselbe</translation>
    </message>
</context>
<context>
    <name>Readouts</name>
    <message>
        <source>Speed</source>
        <translation>Drehzahl</translation>
    </message>
    <message>
        <source>Pressure</source>
        <translation>Druck</translation>
    </message>
    <message>
        <source>Torque</source>
        <translation>Moment</translation>
    </message>
    <message>
        <source>Disc</source>
        <translation>Scheibe</translation>
    </message>
    <message>
        <source>Speed of the disc; the blue mark is the commanded speed</source>
        <translation>Drehzahl der Scheibe; die blaue Marke ist die befohlene</translation>
    </message>
    <message>
        <source>Brake pressure; the blue mark is the commanded pressure</source>
        <translation>Bremsdruck; die blaue Marke ist der befohlene</translation>
    </message>
    <message>
        <source>Brake torque at the flange</source>
        <translation>Bremsmoment am Flansch</translation>
    </message>
    <message>
        <source>Temperature of the rub surface of the disc, by the pyrometer</source>
        <translation>Temperatur der Reibfläche der Scheibe, vom Pyrometer</translation>
    </message>
    <message>
        <source>Hatched: amber beyond what the rig may do, red where it is stopped</source>
        <translation>Schraffiert: gelb, was der Prüfstand nicht mehr darf; rot, wo er angehalten wird</translation>
    </message>
    <message>
        <source>Friction mu</source>
        <translation>Reibwert µ</translation>
    </message>
    <message>
        <source>Momentary coefficient of friction, from torque and pressure</source>
        <translation>Augenblicklicher Reibwert, aus Moment und Druck</translation>
    </message>
    <message>
        <source>Sound level</source>
        <translation>Schallpegel</translation>
    </message>
    <message>
        <source>Sound level of the microphone, A-weighted, fast, dB re 20 µPa</source>
        <translation>Schallpegel des Mikrofons, A-bewertet, Fast, dB re 20 µPa</translation>
    </message>
</context>
<context>
    <name>RecordRow</name>
    <message>
        <source>Record a braking</source>
        <translation>Bremsung aufzeichnen</translation>
    </message>
    <message>
        <source>How long the pressure is on</source>
        <translation>Wie lange der Druck anliegt</translation>
    </message>
    <message>
        <source>comment, stored with the braking</source>
        <translation>Kommentar, mit der Bremsung gespeichert</translation>
    </message>
    <message>
        <source>Stored with the braking and shown on the Data page</source>
        <translation>Mit der Bremsung gespeichert und auf der Seite Daten gezeigt</translation>
    </message>
    <message>
        <source>Start bra&amp;king</source>
        <translation>Bremsung &amp;starten</translation>
    </message>
    <message>
        <source>Noise rating</source>
        <translation>Geräuschnote</translation>
    </message>
    <message>
        <source>Duration in s</source>
        <translation>Dauer in s</translation>
    </message>
    <message>
        <source>Comme&amp;nt</source>
        <translation>&amp;Kommentar</translation>
    </message>
    <message>
        <source>Spins up to the speed, applies the pressure for the duration, and stores every signal</source>
        <translation>Fährt auf die Drehzahl, legt den Druck für die Dauer an und speichert alle Signale</translation>
    </message>
    <message>
        <source>Recording</source>
        <translation>Aufzeichnung</translation>
    </message>
    <message>
        <source>recording, {0} left</source>
        <translation>zeichnet auf, noch {0}</translation>
    </message>
</context>
<context>
    <name>RecordingSection</name>
    <message>
        <source>Sa&amp;mpling rate</source>
        <translation>&amp;Abtastrate</translation>
    </message>
    <message>
        <source>All channels are sampled at this rate, then decimated</source>
        <translation>Alle Kanäle werden mit dieser Rate abgetastet, dann dezimiert</translation>
    </message>
    <message>
        <source>From &amp;before the pressure</source>
        <translation>Ab &amp;vor dem Druck</translation>
    </message>
    <message>
        <source>Recorded before the pressure comes on: the background noise</source>
        <translation>Aufgezeichnet, bevor der Druck kommt: das Hintergrundgeräusch</translation>
    </message>
    <message>
        <source>To &amp;after the release</source>
        <translation>B&amp;is nach dem Lösen</translation>
    </message>
    <message>
        <source>Recorded after the braking</source>
        <translation>Nach der Bremsung aufgezeichnet</translation>
    </message>
    <message>
        <source>Channel</source>
        <translation>Kanal</translation>
    </message>
    <message>
        <source>Decimation</source>
        <translation>Dezimierung</translation>
    </message>
    <message>
        <source>Stored rate</source>
        <translation>Speicherrate</translation>
    </message>
    <message>
        <source>Rig&apos;s rate</source>
        <translation>Rate des Prüfstands</translation>
    </message>
    <message>
        <source>Every how manyth value is stored, behind an anti-alias filter</source>
        <translation>Jeder wievielte Wert gespeichert wird, nach einem Anti-Aliasing-Filter</translation>
    </message>
    <message>
        <source>Store this channel</source>
        <translation>Diesen Kanal speichern</translation>
    </message>
    <message>
        <source>1 stores every value, 40 every fortieth</source>
        <translation>1 speichert jeden Wert, 40 jeden vierzigsten</translation>
    </message>
    <message>
        <source>Decimation of {0}</source>
        <translation>Dezimierung von {0}</translation>
    </message>
</context>
<context>
    <name>ResultPanel</name>
    <message>
        <source>&amp;Resume</source>
        <translation>&amp;Fortsetzen</translation>
    </message>
    <message>
        <source>Do what is not complete</source>
        <translation>Nachholen, was nicht vollständig ist</translation>
    </message>
    <message>
        <source>Rese&amp;t…</source>
        <translation>&amp;Rücksetzen…</translation>
    </message>
    <message>
        <source>Acknowledge the trip in your words, without going on</source>
        <translation>Die Auslösung mit eigenen Worten quittieren, ohne fortzusetzen</translation>
    </message>
    <message>
        <source>Open &amp;data</source>
        <translation>Da&amp;ten öffnen</translation>
    </message>
    <message>
        <source>This campaign on the Data page</source>
        <translation>Diese Kampagne auf der Seite Daten</translation>
    </message>
    <message>
        <source>Open re&amp;port</source>
        <translation>&amp;Bericht öffnen</translation>
    </message>
    <message>
        <source>There is none yet</source>
        <translation>Es gibt noch keine</translation>
    </message>
    <message>
        <source>&amp;Other programs</source>
        <translation>Andere Pro&amp;gramme</translation>
    </message>
    <message>
        <source>Programs and campaigns that can be run</source>
        <translation>Programme und Kampagnen, die laufen können</translation>
    </message>
    <message>
        <source>Resume</source>
        <translation>Fortsetzen</translation>
    </message>
    <message>
        <source>Go on with the first braking that is not complete</source>
        <translation>Mit der ersten nicht vollständigen Bremsung weitermachen</translation>
    </message>
    <message>
        <source>Reset</source>
        <translation>Rücksetzen</translation>
    </message>
    <message>
        <source>Put it into the journal (Enter)</source>
        <translation>Ins Journal schreiben (Enter)</translation>
    </message>
    <message>
        <source>Figures and report of the campaign, in the browser</source>
        <translation>Grafiken und Bericht der Kampagne, im Browser</translation>
    </message>
    <message>
        <source>There is no report yet; it is made at the end of a run.</source>
        <translation>Es gibt noch keinen Bericht; er entsteht am Ende eines Laufs.</translation>
    </message>
    <message>
        <source>The program is through: {0} of {1} brakings are complete.</source>
        <translation>Das Programm ist durch: {0} von {1} Bremsungen vollständig.</translation>
    </message>
    <message>
        <source>Stopped by the operator: {0} of {1} brakings are complete.</source>
        <translation>Von Hand angehalten: {0} von {1} Bremsungen vollständig.</translation>
    </message>
    <message>
        <source>Stopped by the watchdog: {0} of {1} brakings are complete.</source>
        <translation>Vom Wächter angehalten: {0} von {1} Bremsungen vollständig.</translation>
    </message>
    <message>
        <source>The run has failed: {0} of {1} brakings are complete.</source>
        <translation>Der Lauf ist fehlgeschlagen: {0} von {1} Bremsungen vollständig.</translation>
    </message>
    <message>
        <source>Tried but not complete: {0}.</source>
        <translation>Versucht, aber nicht vollständig: {0}.</translation>
    </message>
    <message>
        <source>What was the cause, and what was done? It goes into the journal.</source>
        <translation>Was war die Ursache, und was wurde getan? Es kommt ins Journal.</translation>
    </message>
    <message>
        <source>e.g. vent valve was closed; opened it</source>
        <translation>z. B. Entlüftungsventil war zu; geöffnet</translation>
    </message>
    <message>
        <source>What was the cause, and what was done? The watchdog wants it before it arms again.</source>
        <translation>Was war die Ursache, und was wurde getan? Der Wächter will es wissen, bevor er wieder scharf schaltet.</translation>
    </message>
</context>
<context>
    <name>RigChoice</name>
    <message>
        <source>Limits and channels are those of this rig, and it is the one that is started</source>
        <translation>Grenzwerte und Kanäle gelten für diesen Prüfstand, und er wird gestartet</translation>
    </message>
    <message>
        <source>R&amp;ig</source>
        <translation>&amp;Prüfstand</translation>
    </message>
    <message>
        <source>simulated</source>
        <translation>simuliert</translation>
    </message>
    <message>
        <source>REAL RIG</source>
        <translation>ECHTER PRÜFSTAND</translation>
    </message>
</context>
<context>
    <name>RigConnection</name>
    <message>
        <source>A session is running already. End it first.</source>
        <translation>Eine Sitzung läuft schon. Sie zuerst beenden.</translation>
    </message>
    <message>
        <source>The session cannot be started: {0}</source>
        <translation>Die Sitzung lässt sich nicht starten: {0}</translation>
    </message>
    <message>
        <source>starting …</source>
        <translation>startet …</translation>
    </message>
    <message>
        <source>no news of the controller for {0} s</source>
        <translation>seit {0} s nichts von der Steuerung gehört</translation>
    </message>
    <message>
        <source>The session has ended at once, without a word.</source>
        <translation>Die Sitzung endete sofort, ohne ein Wort.</translation>
    </message>
    <message>
        <source>The session has ended after its controller had gone.</source>
        <translation>Die Sitzung endete, nachdem ihre Steuerung weg war.</translation>
    </message>
    <message>
        <source>The session has ended: {0}.</source>
        <translation>Die Sitzung ist beendet: {0}.</translation>
    </message>
    <message>
        <source>No controller is connected. In danger use the emergency stop.</source>
        <translation>Keine Steuerung ist verbunden. Bei Gefahr den Not-Halt drücken.</translation>
    </message>
    <message>
        <source>reset; nothing runs</source>
        <translation>rückgesetzt; nichts läuft</translation>
    </message>
    <message>
        <source>Nothing has tripped.</source>
        <translation>Nichts hat ausgelöst.</translation>
    </message>
    <message>
        <source>No controller is connected.</source>
        <translation>Keine Steuerung ist verbunden.</translation>
    </message>
</context>
<context>
    <name>RunPage</name>
    <message>
        <source>Follow</source>
        <translation>Folgen</translation>
    </message>
    <message>
        <source>Keep the present braking in sight; scrolling by hand ends it</source>
        <translation>Die laufende Bremsung im Blick behalten; Rollen von Hand beendet es</translation>
    </message>
    <message>
        <source>Starting the controller …</source>
        <translation>Steuerung startet …</translation>
    </message>
    <message>
        <source>1 braking</source>
        <translation>1 Bremsung</translation>
    </message>
    <message>
        <source>{0} brakings</source>
        <translation>{0} Bremsungen</translation>
    </message>
    <message>
        <source>, squeal in {0} of {1}</source>
        <translation>, Quietschen bei {0} von {1}</translation>
    </message>
    <message>
        <source>Braking {0} has no recording yet.</source>
        <translation>Bremsung {0} hat noch keine Aufzeichnung.</translation>
    </message>
    <message>
        <source>&lt;h3&gt;Run&lt;/h3&gt;&lt;p&gt;Watch a program: every braking is a row, the map fills with squeal over pressure and temperature, the traces show the present braking. The tips of the verbs say what will happen. Closing this window does not stop the run.&lt;/p&gt;&lt;p&gt;&lt;b&gt;1 … 9&lt;/b&gt; noise rating of the present braking&lt;br&gt;&lt;b&gt;N&lt;/b&gt; write a note, Enter puts it into the journal, Esc leaves&lt;br&gt;&lt;b&gt;Enter&lt;/b&gt; or double click opens a braking on the Data page; so does a click on the map&lt;br&gt;&lt;b&gt;Alt + underlined letter&lt;/b&gt; presses a button&lt;br&gt;&lt;b&gt;F12&lt;/b&gt; software stop&lt;/p&gt;&lt;p&gt;&lt;b&gt;Follow&lt;/b&gt; keeps the present braking in sight until you scroll.&lt;/p&gt;</source>
        <translation>&lt;h3&gt;Lauf&lt;/h3&gt;&lt;p&gt;Ein Programm verfolgen: jede Bremsung ist eine Zeile, die Karte füllt sich mit Quietschen über Druck und Temperatur, die Kurven zeigen die laufende Bremsung. Die Tipps der Befehle sagen, was geschehen wird. Schließen dieses Fensters hält den Lauf nicht an.&lt;/p&gt;&lt;p&gt;&lt;b&gt;1 … 9&lt;/b&gt; Geräuschnote der laufenden Bremsung&lt;br&gt;&lt;b&gt;N&lt;/b&gt; Notiz schreiben, Enter bringt sie ins Journal, Esc verlässt sie&lt;br&gt;&lt;b&gt;Enter&lt;/b&gt; oder Doppelklick öffnet eine Bremsung auf der Seite Daten; ebenso ein Klick in die Karte&lt;br&gt;&lt;b&gt;Alt + unterstrichener Buchstabe&lt;/b&gt; drückt eine Taste&lt;br&gt;&lt;b&gt;F12&lt;/b&gt; Software-Stopp&lt;/p&gt;&lt;p&gt;&lt;b&gt;Folgen&lt;/b&gt; behält die laufende Bremsung im Blick, bis von Hand gerollt wird.&lt;/p&gt;</translation>
    </message>
</context>
<context>
    <name>SafetyBox</name>
    <message>
        <source>&amp;Take command</source>
        <translation>Komm&amp;ando übernehmen</translation>
    </message>
    <message>
        <source>Command from this window; whoever commands now is told</source>
        <translation>Von diesem Fenster aus befehlen; wer jetzt befiehlt, wird benachrichtigt</translation>
    </message>
    <message>
        <source>Res&amp;et…</source>
        <translation>&amp;Rücksetzen…</translation>
    </message>
    <message>
        <source>Acknowledge the trip in your words. The rig is locked then; nothing moves by it.</source>
        <translation>Die Auslösung mit eigenen Worten quittieren. Danach ist der Prüfstand gesperrt; nichts bewegt sich dadurch.</translation>
    </message>
    <message>
        <source>Reset</source>
        <translation>Rücksetzen</translation>
    </message>
    <message>
        <source>&amp;Enable</source>
        <translation>&amp;Freigeben</translation>
    </message>
    <message>
        <source>&amp;Disable</source>
        <translation>S&amp;perren</translation>
    </message>
    <message>
        <source>Releases the pressure, brings the disc to rest, opens the safety relay</source>
        <translation>Lässt den Druck ab, bringt die Scheibe zum Stillstand, öffnet das Sicherheitsrelais</translation>
    </message>
    <message>
        <source>End session</source>
        <translation>Sitzung beenden</translation>
    </message>
    <message>
        <source>Comes to rest, locks, and ends the controller of this session</source>
        <translation>Fährt zum Stillstand, sperrt und beendet die Steuerung dieser Sitzung</translation>
    </message>
    <message>
        <source>Enable &amp;now</source>
        <translation>&amp;Jetzt freigeben</translation>
    </message>
    <message>
        <source>The watchdog closes the safety relay</source>
        <translation>Der Wächter schließt das Sicherheitsrelais</translation>
    </message>
    <message>
        <source>Let motor and brake be moved; says first what will move</source>
        <translation>Motor und Bremse beweglich machen; sagt vorher, was sich bewegen wird</translation>
    </message>
    <message>
        <source>What was the cause, and what was done? It goes into the journal.</source>
        <translation>Was war die Ursache, und was wurde getan? Es kommt ins Journal.</translation>
    </message>
    <message>
        <source>e.g. vent valve was closed; opened it</source>
        <translation>z. B. Entlüftungsventil war zu; geöffnet</translation>
    </message>
</context>
<context>
    <name>SensorRow</name>
    <message>
        <source>well</source>
        <translation>gut</translation>
    </message>
    <message>
        <source>no valid reading</source>
        <translation>kein gültiger Wert</translation>
    </message>
    <message>
        <source>frozen</source>
        <translation>eingefroren</translation>
    </message>
    <message>
        <source>reads off by</source>
        <translation>zeigt falsch um</translation>
    </message>
    <message>
        <source>What the sensor does</source>
        <translation>Was der Sensor tut</translation>
    </message>
    <message>
        <source>both see it</source>
        <translation>beide sehen es</translation>
    </message>
    <message>
        <source>controller only</source>
        <translation>nur Steuerung</translation>
    </message>
    <message>
        <source>watchdog only</source>
        <translation>nur Wächter</translation>
    </message>
    <message>
        <source>The watchdog has sensors of its own</source>
        <translation>Der Wächter hat eigene Sensoren</translation>
    </message>
    <message>
        <source>Apply</source>
        <translation>Anwenden</translation>
    </message>
</context>
<context>
    <name>SequenceEditor</name>
    <message>
        <source>Set-points</source>
        <translation>Sollwerte</translation>
    </message>
    <message>
        <source>Pressure course</source>
        <translation>Druckverlauf</translation>
    </message>
    <message>
        <source>Conditioning</source>
        <translation>Konditionierung</translation>
    </message>
    <message>
        <source>Recording</source>
        <translation>Aufzeichnung</translation>
    </message>
</context>
<context>
    <name>SequencePage</name>
    <message>
        <source>Program “{0}” on the sequence page</source>
        <translation>Programm „{0}“ auf der Seite Sequenz</translation>
    </message>
    <message>
        <source>&lt;p&gt;A program is a list of sequences; a sequence runs its lists of temperatures, speeds and pressures. What is wrong stands at its field and in the list on the right; a click there leads to the field.&lt;/p&gt;&lt;p&gt;In the lists: type numbers and press Enter, paste from a spreadsheet (Ctrl+V), Del deletes rows, + joins a speed row with the one above. The order of the loops is changed by dragging, or with Ctrl and the arrow keys.&lt;/p&gt;&lt;p&gt;Ctrl+N new · Ctrl+O open · Ctrl+S save · Ctrl+Shift+S save as · Ctrl+Z undo · Ctrl+Y redo · Alt+Up, Alt+Down move a sequence · Del remove it&lt;/p&gt;</source>
        <translation>&lt;p&gt;Ein Programm ist eine Liste von Sequenzen; eine Sequenz arbeitet ihre Listen von Temperaturen, Drehzahlen und Drücken ab. Was falsch ist, steht am Feld und in der Liste rechts; ein Klick dort führt zum Feld.&lt;/p&gt;&lt;p&gt;In den Listen: Zahlen tippen und Enter drücken, aus einer Tabelle einfügen (Strg+V), Entf löscht Zeilen, + verbindet eine Drehzahlzeile mit der darüber. Die Schleifenfolge wird durch Ziehen geändert oder mit Strg und Pfeiltasten.&lt;/p&gt;&lt;p&gt;Strg+N neu · Strg+O öffnen · Strg+S speichern · Strg+Umschalt+S speichern als · Strg+Z rückgängig · Strg+Y wiederherstellen · Alt+Auf, Alt+Ab Sequenz verschieben · Entf entfernt sie&lt;/p&gt;</translation>
    </message>
    <message>
        <source>new program</source>
        <translation>neues Programm</translation>
    </message>
    <message>
        <source>“{0}” is removed; Ctrl+Z brings it back</source>
        <translation>„{0}“ ist entfernt; Strg+Z holt es zurück</translation>
    </message>
    <message>
        <source>First put right what is marked: only then durations can be estimated.</source>
        <translation>Zuerst Markiertes berichtigen: erst dann lassen sich Dauern schätzen.</translation>
    </message>
    <message>
        <source>Estimating …</source>
        <translation>Wird geschätzt …</translation>
    </message>
    <message>
        <source>No course: the sequence is off</source>
        <translation>Kein Verlauf: die Sequenz ist aus</translation>
    </message>
    <message>
        <source>First put right what is marked.</source>
        <translation>Zuerst Markiertes berichtigen.</translation>
    </message>
    <message>
        <source>No rig file is found.</source>
        <translation>Keine Prüfstandsdatei gefunden.</translation>
    </message>
    <message>
        <source>estimating …</source>
        <translation>wird geschätzt …</translation>
    </message>
    <message>
        <source>Cannot be started, the check failed: {0}</source>
        <translation>Kein Start, die Prüfung schlug fehl: {0}</translation>
    </message>
</context>
<context>
    <name>ServicePage</name>
    <message>
        <source>&amp;Devices</source>
        <translation>&amp;Geräte</translation>
    </message>
    <message>
        <source>&amp;Calibrations</source>
        <translation>&amp;Kalibrierungen</translation>
    </message>
    <message>
        <source>&amp;Alarms</source>
        <translation>&amp;Alarme</translation>
    </message>
    <message>
        <source>&amp;Journal</source>
        <translation>&amp;Journal</translation>
    </message>
    <message>
        <source>Fault &amp;laboratory</source>
        <translation>&amp;Fehlerlabor</translation>
    </message>
    <message>
        <source>&amp;Window</source>
        <translation>Fe&amp;nster</translation>
    </message>
    <message>
        <source>&amp;Alarms ({0})</source>
        <translation>&amp;Alarme ({0})</translation>
    </message>
    <message>
        <source>&lt;b&gt;Service&lt;/b&gt;&lt;p&gt;&lt;b&gt;Devices&lt;/b&gt;: who they are, newest values, settings that are unsafe.&lt;br&gt;&lt;b&gt;Calibrations&lt;/b&gt;: torque by lever and weights, microphone by calibrator, emissivity by contact thermometer; a saved one holds from the next start of the rig.&lt;br&gt;&lt;b&gt;Alarms&lt;/b&gt;: what needs a person, with what to do; acknowledging is journaled.&lt;br&gt;&lt;b&gt;Journal&lt;/b&gt;: everything that happened, searched by words, process and kind.&lt;br&gt;&lt;b&gt;Fault laboratory&lt;/b&gt;: make things go wrong on a simulated rig.&lt;br&gt;&lt;b&gt;Window&lt;/b&gt;: language, look, size of text, data folder.&lt;/p&gt;&lt;p&gt;Ctrl+Tab next tab · Enter takes a reading or acknowledges · Esc leaves a calibration&lt;/p&gt;</source>
        <translation>&lt;b&gt;Service&lt;/b&gt;&lt;p&gt;&lt;b&gt;Geräte&lt;/b&gt;: wer sie sind, neueste Werte, unsichere Einstellungen.&lt;br&gt;&lt;b&gt;Kalibrierungen&lt;/b&gt;: Moment mit Hebel und Gewichten, Mikrofon mit Kalibrator, Emissionsgrad mit Kontaktthermometer; eine gespeicherte gilt ab dem nächsten Start des Prüfstands.&lt;br&gt;&lt;b&gt;Alarme&lt;/b&gt;: was einen Menschen braucht, und was zu tun ist; Quittieren kommt ins Journal.&lt;br&gt;&lt;b&gt;Journal&lt;/b&gt;: alles, was geschah, durchsuchbar nach Wörtern, Prozess und Art.&lt;br&gt;&lt;b&gt;Fehlerlabor&lt;/b&gt;: an einem simulierten Prüfstand etwas schiefgehen lassen.&lt;br&gt;&lt;b&gt;Fenster&lt;/b&gt;: Sprache, Darstellung, Schriftgröße, Datenordner.&lt;/p&gt;&lt;p&gt;Strg+Tab nächste Karteikarte · Enter nimmt einen Wert auf oder quittiert · Esc verlässt eine Kalibrierung&lt;/p&gt;</translation>
    </message>
</context>
<context>
    <name>SetpointsSection</name>
    <message>
        <source>All combinations</source>
        <translation>Schleifenweise</translation>
    </message>
    <message>
        <source>Entry by entry</source>
        <translation>Listenweise</translation>
    </message>
    <message>
        <source>All combinations: every temperature with every speed and every pressure.
Entry by entry: the first ones together, then the second ones, …; a list of one value holds for all.</source>
        <translation>Schleifenweise: jede Temperatur mit jeder Drehzahl und jedem Druck.
Listenweise: die ersten zusammen, dann die zweiten, …; eine Liste mit einem Wert gilt für alle.</translation>
    </message>
    <message>
        <source>Order of the loops, outermost first. Drag a chip, or use Ctrl with the arrow keys.</source>
        <translation>Schleifenfolge, äußerste zuerst. Ein Plättchen ziehen, oder Strg mit Pfeiltasten.</translation>
    </message>
    <message>
        <source>Order of the loops</source>
        <translation>Schleifenfolge</translation>
    </message>
    <message>
        <source>Compare …</source>
        <translation>Vergleichen …</translation>
    </message>
    <message>
        <source>How long the program takes with other orders of the loops</source>
        <translation>Wie lange das Programm mit anderen Schleifenfolgen dauert</translation>
    </message>
</context>
<context>
    <name>SlidersPanel</name>
    <message>
        <source>Sin&amp;gle quantities too</source>
        <translation>Auch &amp;Einzelgrößen</translation>
    </message>
    <message>
        <source>Only &amp;changed</source>
        <translation>&amp;Nur geänderte</translation>
    </message>
    <message>
        <source>&amp;Reset all sliders</source>
        <translation>Alle Regler &amp;rücksetzen</translation>
    </message>
    <message>
        <source>Search, e.g. piston stiffness</source>
        <translation>Suchen, z. B. piston stiffness</translation>
    </message>
    <message>
        <source>Words of a group&apos;s name, in any order</source>
        <translation>Wörter aus dem Namen einer Gruppe, in beliebiger Folge</translation>
    </message>
    <message>
        <source>Every number of the brake file, not only its groups</source>
        <translation>Jede Zahl der Bremsendatei, nicht nur ihre Gruppen</translation>
    </message>
    <message>
        <source>Only what has another factor than 1</source>
        <translation>Nur was einen anderen Faktor als 1 hat</translation>
    </message>
    <message>
        <source>All sliders back to the values of the brake file</source>
        <translation>Alle Regler zurück auf die Werte der Bremsendatei</translation>
    </message>
    <message>
        <source>Choose what the slider below changes</source>
        <translation>Wählen, was der Regler unten ändert</translation>
    </message>
    <message>
        <source>Parameters of the brake</source>
        <translation>Parameter der Bremse</translation>
    </message>
    <message>
        <source>Nothing of this name.</source>
        <translation>Nichts mit diesem Namen.</translation>
    </message>
</context>
<context>
    <name>SoundBar</name>
    <message>
        <source>&amp;Equal loudness</source>
        <translation>Gleic&amp;h laut</translation>
    </message>
    <message>
        <source>Every braking sounds equally loud. Off: all with one gain, so that they can be compared.</source>
        <translation>Jede Bremsung klingt gleich laut. Aus: alle mit einer Verstärkung, so dass sie vergleichbar sind.</translation>
    </message>
    <message>
        <source>Save as &amp;WAV…</source>
        <translation>Als &amp;WAV speichern…</translation>
    </message>
    <message>
        <source>The sound as recorded, 16 bit; Pa per count stands in the file&apos;s comment</source>
        <translation>Der Ton wie aufgezeichnet, 16 Bit; Pa je Zähler steht im Kommentar der Datei</translation>
    </message>
    <message>
        <source>Recorded without sound</source>
        <translation>Ohne Ton aufgezeichnet</translation>
    </message>
    <message>
        <source>Preparing …</source>
        <translation>Wird vorbereitet …</translation>
    </message>
    <message>
        <source>Louder by {0} dB</source>
        <translation>Lauter um {0} dB</translation>
    </message>
    <message>
        <source>20 Pa is full scale</source>
        <translation>20 Pa ist Vollausschlag</translation>
    </message>
    <message>
        <source>■ Sto&amp;p</source>
        <translation>■ &amp;Anhalten</translation>
    </message>
    <message>
        <source>▶ &amp;Play</source>
        <translation>▶ &amp;Abspielen</translation>
    </message>
    <message>
        <source>Stop the sound</source>
        <translation>Den Ton anhalten</translation>
    </message>
    <message>
        <source>Listen to the microphone&apos;s sound</source>
        <translation>Den Ton des Mikrofons hören</translation>
    </message>
    <message>
        <source>Save the sound</source>
        <translation>Ton speichern</translation>
    </message>
    <message>
        <source>Sound (*.wav)</source>
        <translation>Ton (*.wav)</translation>
    </message>
    <message>
        <source>Saved as {0}</source>
        <translation>Gespeichert als {0}</translation>
    </message>
</context>
<context>
    <name>SoundView</name>
    <message>
        <source>Microphone by calibrator</source>
        <translation>Mikrofon mit Kalibrator</translation>
    </message>
    <message>
        <source>Calibrator</source>
        <translation>Kalibrator</translation>
    </message>
    <message>
        <source>Level that is set at the calibrator (1 kHz)</source>
        <translation>Pegel, der am Kalibrator eingestellt ist (1 kHz)</translation>
    </message>
    <message>
        <source>Calibrator of the &amp;simulated rig</source>
        <translation>Kalibrator des &amp;simulierten Prüfstands</translation>
    </message>
    <message>
        <source>The fault laboratory puts a calibrator of that level on the microphone</source>
        <translation>Das Fehlerlabor setzt einen Kalibrator dieses Pegels auf das Mikrofon</translation>
    </message>
    <message>
        <source>&amp;Record {0:g} s</source>
        <translation>{0:g} s auf&amp;zeichnen</translation>
    </message>
    <message>
        <source>Record the tone and find the sensitivity; once for each level</source>
        <translation>Den Ton aufzeichnen und die Empfindlichkeit bestimmen; einmal je Pegel</translation>
    </message>
    <message>
        <source>Push the calibrator on to its stop, choose its level, switch it on and wait until the level below stands still. Then record. Ventilator and motor off.</source>
        <translation>Kalibrator bis zum Anschlag aufschieben, Pegel wählen, einschalten und warten, bis der Pegel unten still steht. Dann aufzeichnen. Lüfter und Motor aus.</translation>
    </message>
    <message>
        <source>Level</source>
        <translation>Pegel</translation>
    </message>
    <message>
        <source>Sensitivity</source>
        <translation>Empfindlichkeit</translation>
    </message>
    <message>
        <source>Tone</source>
        <translation>Ton</translation>
    </message>
    <message>
        <source>Moves by</source>
        <translation>Schwankt um</translation>
    </message>
    <message>
        <source>Above rest</source>
        <translation>Über Ruhe</translation>
    </message>
    <message>
        <source>No recording yet.</source>
        <translation>Noch keine Aufzeichnung.</translation>
    </message>
    <message>
        <source>Sa&amp;ve calibration</source>
        <translation>Kalib&amp;rierung speichern</translation>
    </message>
    <message>
        <source>Recordings</source>
        <translation>Aufzeichnungen</translation>
    </message>
    <message>
        <source>No sound yet. A simulated rig gives sound at rest only while a calibrator is on its microphone.</source>
        <translation>Noch kein Ton. Ein simulierter Prüfstand gibt im Stillstand nur Ton, während ein Kalibrator auf seinem Mikrofon sitzt.</translation>
    </message>
    <message>
        <source>No sound yet: wait until the rig has started.</source>
        <translation>Noch kein Ton: warten, bis der Prüfstand gestartet ist.</translation>
    </message>
    <message>
        <source>newest sound, with the nominal sensitivity</source>
        <translation>neuester Ton, mit der Nennempfindlichkeit</translation>
    </message>
    <message>
        <source>Evaluating …</source>
        <translation>Wird ausgewertet …</translation>
    </message>
    <message>
        <source>{0} mPa/count</source>
        <translation>{0} mPa/Zähler</translation>
    </message>
    <message>
        <source>{0:.5f} mPa per count: {1} dB against the nominal sensitivity</source>
        <translation>{0:.5f} mPa je Zähler: {1} dB gegen die Nennempfindlichkeit</translation>
    </message>
    <message>
        <source>; drift since the last calibration {0} dB</source>
        <translation>; Drift seit der letzten Kalibrierung {0} dB</translation>
    </message>
    <message>
        <source>; the levels agree within {0} dB</source>
        <translation>; die Pegel stimmen auf {0} dB überein</translation>
    </message>
    <message>
        <source>Keep it; it holds from the next start of the rig</source>
        <translation>Behalten; gilt ab dem nächsten Start des Prüfstands</translation>
    </message>
    <message>
        <source>A recording is needed that nothing speaks against</source>
        <translation>Es braucht eine Aufzeichnung, gegen die nichts spricht</translation>
    </message>
</context>
<context>
    <name>SpectrogramPlot</name>
    <message>
        <source>Spectrogram (kHz, dB)</source>
        <translation>Spektrogramm (kHz, dB)</translation>
    </message>
    <message>
        <source>Scale of colours: choose its range</source>
        <translation>Farbskala: ihren Bereich wählen</translation>
    </message>
    <message>
        <source>{0} to {1} dB</source>
        <translation>{0} bis {1} dB</translation>
    </message>
</context>
<context>
    <name>SpectrumPlot</name>
    <message>
        <source>Spectrum (dB re 20 µPa)</source>
        <translation>Spektrum (dB re 20 µPa)</translation>
    </message>
    <message>
        <source>Frequency (kHz)</source>
        <translation>Frequenz (kHz)</translation>
    </message>
    <message>
        <source>No sound at cursor A.</source>
        <translation>Kein Ton bei Cursor A.</translation>
    </message>
    <message>
        <source>No sound yet.</source>
        <translation>Noch kein Ton.</translation>
    </message>
    <message>
        <source>threshold {0}</source>
        <translation>Schwelle {0}</translation>
    </message>
    <message>
        <source>at A {0}, dotted: B</source>
        <translation>bei A {0}, gepunktet: B</translation>
    </message>
    <message>
        <source>newest sound, from {0}</source>
        <translation>neuester Ton, ab {0}</translation>
    </message>
    <message>
        <source>squeal {0}</source>
        <translation>Quietschen {0}</translation>
    </message>
</context>
<context>
    <name>SpeedBox</name>
    <message>
        <source>Motor</source>
        <translation>Motor</translation>
    </message>
    <message>
        <source>Speed of the disc. Enter applies; blue is the commanded speed.</source>
        <translation>Drehzahl der Scheibe. Enter übernimmt; blau ist die befohlene.</translation>
    </message>
    <message>
        <source>How fast the speed changes</source>
        <translation>Wie schnell die Drehzahl sich ändert</translation>
    </message>
    <message>
        <source>Set speed</source>
        <translation>Drehzahl stellen</translation>
    </message>
    <message>
        <source>Stop &amp;motor</source>
        <translation>&amp;Motor anhalten</translation>
    </message>
    <message>
        <source>&amp;Speed</source>
        <translation>&amp;Drehzahl</translation>
    </message>
    <message>
        <source>Ramp</source>
        <translation>Rampe</translation>
    </message>
    <message>
        <source>Go to this speed along the ramp (Enter)</source>
        <translation>Über die Rampe auf diese Drehzahl fahren (Enter)</translation>
    </message>
    <message>
        <source>Go to 0 1/min with the fastest ramp</source>
        <translation>Mit der schnellsten Rampe auf 0 1/min fahren</translation>
    </message>
</context>
<context>
    <name>StartPanel</name>
    <message>
        <source>Run a program</source>
        <translation>Ein Programm laufen lassen</translation>
    </message>
    <message>
        <source>A program is a list of brakings that the rig carries out by itself, for minutes or nights. Choose one to look at it, change it and start it on the Sequence page. Here you watch it: the table of brakings, the map of squeal, pause, skip, repeat, abort.</source>
        <translation>Ein Programm ist eine Liste von Bremsungen, die der Prüfstand allein ausführt, minutenlang oder nächtelang. Eines wählen, um es auf der Seite Sequenz anzusehen, zu ändern und zu starten. Hier wird es verfolgt: Tabelle der Bremsungen, Quietschkarte, Pause, Überspringen, Wiederholen, Beenden.</translation>
    </message>
    <message>
        <source>Programs</source>
        <translation>Programme</translation>
    </message>
    <message>
        <source>Not complete yet</source>
        <translation>Noch nicht vollständig</translation>
    </message>
    <message>
        <source>No campaign waits to be completed.</source>
        <translation>Keine Kampagne ist unvollständig.</translation>
    </message>
    <message>
        <source>Resume</source>
        <translation>Fortsetzen</translation>
    </message>
    <message>
        <source>Go on with the first braking that is not complete</source>
        <translation>Mit der ersten nicht vollständigen Bremsung weitermachen</translation>
    </message>
    <message>
        <source>Open</source>
        <translation>Öffnen</translation>
    </message>
    <message>
        <source>Look at it and start it on the Sequence page</source>
        <translation>Auf der Seite Sequenz ansehen und starten</translation>
    </message>
    <message>
        <source>{0} brakings</source>
        <translation>{0} Bremsungen</translation>
    </message>
    <message>
        <source>{0} of {1}</source>
        <translation>{0} von {1}</translation>
    </message>
    <message>
        <source>{0} ended with a trip: {1} What was the cause, and what was done?</source>
        <translation>{0} endete mit einer Auslösung: {1} Was war die Ursache, und was wurde getan?</translation>
    </message>
    <message>
        <source>e.g. vent valve was closed; opened it</source>
        <translation>z. B. Entlüftungsventil war zu; geöffnet</translation>
    </message>
    <message>
        <source>Start …</source>
        <translation>Starten …</translation>
    </message>
    <message>
        <source>Shows what will be run; a second click starts it</source>
        <translation>Zeigt, was laufen wird; ein zweiter Klick startet es</translation>
    </message>
    <message>
        <source>as fast as it can be computed</source>
        <translation>so schnell wie berechenbar</translation>
    </message>
    <message>
        <source>by the clock</source>
        <translation>nach der Uhr</translation>
    </message>
    <message>
        <source>Time of the simulated rig</source>
        <translation>Zeit des simulierten Prüfstands</translation>
    </message>
    <message>
        <source>any</source>
        <translation>beliebig</translation>
    </message>
    <message>
        <source>A whole number makes the simulated run repeatable bit for bit</source>
        <translation>Eine ganze Zahl macht den simulierten Lauf Bit für Bit wiederholbar</translation>
    </message>
    <message>
        <source>Time</source>
        <translation>Zeit</translation>
    </message>
    <message>
        <source>Seed</source>
        <translation>Startzahl</translation>
    </message>
    <message>
        <source>Start now</source>
        <translation>Jetzt starten</translation>
    </message>
    <message>
        <source>Start the run; the run page follows it</source>
        <translation>Den Lauf starten; die Seite Lauf verfolgt ihn</translation>
    </message>
    <message>
        <source>Cancel</source>
        <translation>Abbrechen</translation>
    </message>
    <message>
        <source>Start nothing (Esc)</source>
        <translation>Nichts starten (Esc)</translation>
    </message>
    <message>
        <source>Enter a whole number of 0 or more, or leave it empty.</source>
        <translation>Eine ganze Zahl ab 0 eingeben oder leer lassen.</translation>
    </message>
</context>
<context>
    <name>Starter</name>
    <message>
        <source>Close</source>
        <translation>Schließen</translation>
    </message>
</context>
<context>
    <name>StateBar</name>
    <message>
        <source>No rig is connected</source>
        <translation>Kein Prüfstand verbunden</translation>
    </message>
    <message>
        <source>Braking {0} of {1}</source>
        <translation>Bremsung {0} von {1}</translation>
    </message>
    <message>
        <source>{0} complete, {1} broken off, {2} with squeal</source>
        <translation>{0} vollständig, {1} abgebrochen, {2} mit Quietschen</translation>
    </message>
    <message>
        <source>{0} left</source>
        <translation>noch {0}</translation>
    </message>
    <message>
        <source>{0} of disk left</source>
        <translation>{0} auf der Platte frei</translation>
    </message>
    <message>
        <source>This window commands</source>
        <translation>Dieses Fenster befiehlt</translation>
    </message>
    <message>
        <source>{0} commands; this window watches</source>
        <translation>{0} befiehlt; dieses Fenster sieht zu</translation>
    </message>
    <message>
        <source>SIMULATED</source>
        <translation>SIMULIERT</translation>
    </message>
    <message>
        <source>REAL RIG</source>
        <translation>ECHTER PRÜFSTAND</translation>
    </message>
    <message>
        <source>OFFLINE</source>
        <translation>GETRENNT</translation>
    </message>
    <message>
        <source>STARTING</source>
        <translation>STARTET</translation>
    </message>
    <message>
        <source>LOCKED</source>
        <translation>GESPERRT</translation>
    </message>
    <message>
        <source>READY</source>
        <translation>BEREIT</translation>
    </message>
    <message>
        <source>RUNNING</source>
        <translation>LÄUFT</translation>
    </message>
    <message>
        <source>PAUSED</source>
        <translation>PAUSE</translation>
    </message>
    <message>
        <source>STOPPING</source>
        <translation>HÄLT AN</translation>
    </message>
    <message>
        <source>TRIPPED</source>
        <translation>AUSGELÖST</translation>
    </message>
</context>
<context>
    <name>StatisticsTable</name>
    <message>
        <source>Statistics</source>
        <translation>Statistik</translation>
    </message>
    <message>
        <source>Unit</source>
        <translation>Einheit</translation>
    </message>
    <message>
        <source>Brakings recorded</source>
        <translation>Aufgezeichnete Bremsungen</translation>
    </message>
    <message>
        <source>complete and counted</source>
        <translation>vollständig und gezählt</translation>
    </message>
    <message>
        <source>excluded</source>
        <translation>ausgeschlossen</translation>
    </message>
    <message>
        <source>incomplete</source>
        <translation>unvollständig</translation>
    </message>
    <message>
        <source>with sound</source>
        <translation>mit Ton</translation>
    </message>
    <message>
        <source>squealing</source>
        <translation>quietschend</translation>
    </message>
    <message>
        <source>Occurrence</source>
        <translation>Häufigkeit</translation>
    </message>
    <message>
        <source>Onset of squeal</source>
        <translation>Einsetzen des Quietschens</translation>
    </message>
    <message>
        <source>Squeal frequency, median</source>
        <translation>Quietschfrequenz, Median</translation>
    </message>
    <message>
        <source>Loudest squeal</source>
        <translation>Lautestes Quietschen</translation>
    </message>
    <message>
        <source>Level of squeal, median</source>
        <translation>Quietschpegel, Median</translation>
    </message>
    <message>
        <source>Mean µ, from … to</source>
        <translation>µ im Mittel, von … bis</translation>
    </message>
</context>
<context>
    <name>StatusPanel</name>
    <message>
        <source>Time left</source>
        <translation>Restzeit</translation>
    </message>
    <message>
        <source>Estimated from the program and the pace so far</source>
        <translation>Geschätzt aus dem Programm und dem bisherigen Tempo</translation>
    </message>
    <message>
        <source>End about</source>
        <translation>Ende etwa</translation>
    </message>
    <message>
        <source>Local time</source>
        <translation>Ortszeit</translation>
    </message>
    <message>
        <source>Rig time</source>
        <translation>Prüfstandszeit</translation>
    </message>
    <message>
        <source>How many seconds of rig time pass in one second</source>
        <translation>Wie viele Sekunden Prüfstandszeit in einer Sekunde vergehen</translation>
    </message>
    <message>
        <source>Complete</source>
        <translation>Vollständig</translation>
    </message>
    <message>
        <source>Complete brakings of all</source>
        <translation>Vollständige Bremsungen von allen</translation>
    </message>
    <message>
        <source>Waiting for the controller</source>
        <translation>Wartet auf die Steuerung</translation>
    </message>
    <message>
        <source>by the clock</source>
        <translation>nach der Uhr</translation>
    </message>
    <message>
        <source>{0} of {1}</source>
        <translation>{0} von {1}</translation>
    </message>
    <message>
        <source>Braking {0}</source>
        <translation>Bremsung {0}</translation>
    </message>
    <message>
        <source>waits after this braking</source>
        <translation>wartet nach dieser Bremsung</translation>
    </message>
</context>
<context>
    <name>TablePane</name>
    <message>
        <source>reading brakings … %p %</source>
        <translation>Bremsungen werden gelesen … %p %</translation>
    </message>
    <message>
        <source>Ctrl or Shift and click: several. Enter: large view. Delete: to the trash.</source>
        <translation>Strg oder Umschalt und Klick: mehrere. Enter: große Ansicht. Entf: in den Papierkorb.</translation>
    </message>
    <message>
        <source>{0} of {1} brakings</source>
        <translation>{0} von {1} Bremsungen</translation>
    </message>
    <message>
        <source>{0} squealing</source>
        <translation>{0} quietschend</translation>
    </message>
    <message>
        <source>{0} chosen</source>
        <translation>{0} gewählt</translation>
    </message>
    <message>
        <source>As delivered</source>
        <translation>Wie ausgeliefert</translation>
    </message>
</context>
<context>
    <name>TagField</name>
    <message>
        <source>cold, check again</source>
        <translation>kalt, nochmals prüfen</translation>
    </message>
    <message>
        <source>Short words for finding brakings again, separated by commas</source>
        <translation>Kurze Wörter zum Wiederfinden von Bremsungen, mit Komma getrennt</translation>
    </message>
</context>
<context>
    <name>TemperatureSection</name>
    <message>
        <source>Before each braking</source>
        <translation>Vor jeder Bremsung</translation>
    </message>
    <message>
        <source>Limits and pauses</source>
        <translation>Grenzen und Pausen</translation>
    </message>
    <message>
        <source>bring the disc to it</source>
        <translation>Scheibe temperieren</translation>
    </message>
    <message>
        <source>Start t&amp;emperature</source>
        <translation>Start&amp;temperatur</translation>
    </message>
    <message>
        <source>Off: brake at whatever temperature the disc has; the list of temperatures is not used.</source>
        <translation>Aus: bremsen, welche Temperatur die Scheibe auch hat; die Liste der Temperaturen bleibt unbenutzt.</translation>
    </message>
    <message>
        <source>&amp;How</source>
        <translation>&amp;Art</translation>
    </message>
    <message>
        <source>heat or cool to it</source>
        <translation>heizen oder kühlen</translation>
    </message>
    <message>
        <source>only cool, at most</source>
        <translation>höchstens kühlen</translation>
    </message>
    <message>
        <source>“Only cool” starts as soon as the disc is not hotter (bedding); it never waits for heat.</source>
        <translation>„Höchstens kühlen“ beginnt, sobald die Scheibe nicht heißer ist (Einbremsen); auf Wärme wird nie gewartet.</translation>
    </message>
    <message>
        <source>To&amp;lerance ±</source>
        <translation>T&amp;oleranz ±</translation>
    </message>
    <message>
        <source>Half width of the band around the start temperature</source>
        <translation>Halbe Breite des Bandes um die Starttemperatur</translation>
    </message>
    <message>
        <source>Soa&amp;k</source>
        <translation>&amp;Haltezeit</translation>
    </message>
    <message>
        <source>How long the disc stays in the band before the braking</source>
        <translation>Wie lange die Scheibe vor der Bremsung im Band bleibt</translation>
    </message>
    <message>
        <source>Ti&amp;me-out</source>
        <translation>&amp;Zeitlimit</translation>
    </message>
    <message>
        <source>Heating, cooling and soaking together may take this long</source>
        <translation>Heizen, Kühlen und Halten dürfen zusammen so lange dauern</translation>
    </message>
    <message>
        <source>Drag speed</source>
        <translation>Schleifdrehzahl</translation>
    </message>
    <message>
        <source>Speed of heating by dragging; empty: the rig&apos;s own</source>
        <translation>Drehzahl beim Heizen durch Schleifen; leer: die des Prüfstands</translation>
    </message>
    <message>
        <source>Drag pressure</source>
        <translation>Schleifdruck</translation>
    </message>
    <message>
        <source>Pressure of heating by dragging; empty: the rig&apos;s own</source>
        <translation>Druck beim Heizen durch Schleifen; leer: der des Prüfstands</translation>
    </message>
    <message>
        <source>Ma&amp;ximum temperature</source>
        <translation>Ma&amp;ximaltemperatur</translation>
    </message>
    <message>
        <source>Hotter than this, braking stops …</source>
        <translation>Ist es heißer, endet das Bremsen …</translation>
    </message>
    <message>
        <source>&amp;Cool-down temperature</source>
        <translation>Abkühlt&amp;emperatur</translation>
    </message>
    <message>
        <source>… and goes on when the disc has cooled to this</source>
        <translation>… und geht weiter, wenn die Scheibe bis hierher abgekühlt ist</translation>
    </message>
    <message>
        <source>Rest &amp;between brakings</source>
        <translation>Pa&amp;use danach</translation>
    </message>
    <message>
        <source>From release to the next braking</source>
        <translation>Vom Lösen bis zur nächsten Bremsung</translation>
    </message>
    <message>
        <source>may run</source>
        <translation>erlaubt</translation>
    </message>
    <message>
        <source>Ventilator while braking</source>
        <translation>Lüfter beim Bremsen</translation>
    </message>
    <message>
        <source>Never with recorded sound: the ventilator would be heard. Between brakings it always cools.</source>
        <translation>Nie bei Tonaufzeichnung: der Lüfter wäre zu hören. Zwischen den Bremsungen kühlt er immer.</translation>
    </message>
    <message>
        <source>rig: {0:g}</source>
        <translation>({0:g})</translation>
    </message>
</context>
<context>
    <name>TimeRows</name>
    <message>
        <source>Time since the first sample [s]</source>
        <translation>Zeit ab dem ersten Abtastwert [s]</translation>
    </message>
    <message>
        <source>Whole braking</source>
        <translation>Ganze Bremsung</translation>
    </message>
    <message>
        <source>Copy picture</source>
        <translation>Bild kopieren</translation>
    </message>
    <message>
        <source>Save picture…</source>
        <translation>Bild speichern…</translation>
    </message>
    <message>
        <source>Picture copied</source>
        <translation>Bild kopiert</translation>
    </message>
    <message>
        <source>Save picture</source>
        <translation>Bild speichern</translation>
    </message>
    <message>
        <source>Picture (*.png)</source>
        <translation>Bild (*.png)</translation>
    </message>
</context>
<context>
    <name>TorquePlots</name>
    <message>
        <source>torque of the weights (N·m)</source>
        <translation>Moment der Gewichte (N·m)</translation>
    </message>
    <message>
        <source>reading (N·m)</source>
        <translation>Ablesung (N·m)</translation>
    </message>
    <message>
        <source>residual (% FS)</source>
        <translation>Rest (% v. E.)</translation>
    </message>
    <message>
        <source>{0}: {1:.1f} N·m applied, {2:.2f} N·m read</source>
        <translation>{0}: {1:.1f} N·m angelegt, {2:.2f} N·m abgelesen</translation>
    </message>
    <message>
        <source>, residual {0:+.2f} N·m</source>
        <translation>, Restabweichung {0:+.2f} N·m</translation>
    </message>
</context>
<context>
    <name>TorqueView</name>
    <message>
        <source>Torque by lever and weights</source>
        <translation>Moment mit Hebel und Gewichten</translation>
    </message>
    <message>
        <source>Lever and weights</source>
        <translation>Hebel und Gewichte</translation>
    </message>
    <message>
        <source>&amp;Begin</source>
        <translation>&amp;Beginnen</translation>
    </message>
    <message>
        <source>Fix these inputs and take the first reading</source>
        <translation>Diese Angaben festhalten und den ersten Wert aufnehmen</translation>
    </message>
    <message>
        <source>Before you begin</source>
        <translation>Vor dem Beginn</translation>
    </message>
    <message>
        <source>Rig at rest, drive disabled, pressure released. Bolt the lever to the frame that carries the brake. Loads go up and down on the right, then on the left: so both directions of rotation, play and friction are seen.</source>
        <translation>Prüfstand im Stillstand, Antrieb gesperrt, Druck abgelassen. Den Hebel an den Rahmen schrauben, der die Bremse trägt. Die Last geht rechts auf und ab, dann links: so zeigen sich beide Drehrichtungen, Spiel und Reibung.</translation>
    </message>
    <message>
        <source>&amp;Take the reading</source>
        <translation>&amp;Wert aufnehmen</translation>
    </message>
    <message>
        <source>Mean of the live torque over {0:g} s; the weights must hang still</source>
        <translation>Mittel des laufenden Moments über {0:g} s; die Gewichte müssen still hängen</translation>
    </message>
    <message>
        <source>Weights of the &amp;simulated rig</source>
        <translation>Gewichte des &amp;simulierten Prüfstands</translation>
    </message>
    <message>
        <source>The fault laboratory hangs the weights on before each reading</source>
        <translation>Das Fehlerlabor hängt die Gewichte vor jeder Ablesung an</translation>
    </message>
    <message>
        <source>&amp;Repeat the selected</source>
        <translation>Gewählten wie&amp;derholen</translation>
    </message>
    <message>
        <source>Take the reading of the selected row again</source>
        <translation>Den Wert der gewählten Zeile neu aufnehmen</translation>
    </message>
    <message>
        <source>Side</source>
        <translation>Seite</translation>
    </message>
    <message>
        <source>kg</source>
        <translation>kg</translation>
    </message>
    <message>
        <source>N·m</source>
        <translation>N·m</translation>
    </message>
    <message>
        <source>Reading</source>
        <translation>Ablesung</translation>
    </message>
    <message>
        <source>Scatter</source>
        <translation>Streuung</translation>
    </message>
    <message>
        <source>Sa&amp;ve calibration</source>
        <translation>Kalib&amp;rierung speichern</translation>
    </message>
    <message>
        <source>△ The watchdog feels the weights too and trips outside {0:g} … {1:g} N·m. Nothing moves by that; reset it when the weights are off.</source>
        <translation>△ Auch der Wächter spürt die Gewichte und löst außerhalb {0:g} … {1:g} N·m aus. Dadurch bewegt sich nichts; rücksetzen, wenn die Gewichte ab sind.</translation>
    </message>
    <message>
        <source>The rig delivers no torque yet: wait until it has started.</source>
        <translation>Der Prüfstand liefert noch kein Moment: warten, bis er gestartet ist.</translation>
    </message>
    <message>
        <source>the torque has no valid reading</source>
        <translation>das Moment hat keinen gültigen Wert</translation>
    </message>
    <message>
        <source>The line is drawn from the third load on.</source>
        <translation>Ab der dritten Last wird die Gerade gezeichnet.</translation>
    </message>
    <message>
        <source>gain {0:.5f}, offset {1:+.2f} N·m; largest residual {2:.3f} %, hysteresis {3:.3f} %, zero {4:.3f} % of full scale</source>
        <translation>Faktor {0:.5f}, Versatz {1:+.2f} N·m; größte Restabweichung {2:.3f} %, Hysterese {3:.3f} %, Nullpunkt {4:.3f} % vom Endwert</translation>
    </message>
    <message>
        <source>right</source>
        <translation>rechts</translation>
    </message>
    <message>
        <source>left</source>
        <translation>links</translation>
    </message>
    <message>
        <source>All readings are taken.</source>
        <translation>Alle Werte sind aufgenommen.</translation>
    </message>
    <message>
        <source>{0}  Lever on the {1}, no weights</source>
        <translation>{0}  Hebel {1}, ohne Gewichte</translation>
    </message>
    <message>
        <source>{0}  {1:g} kg on the {2}</source>
        <translation>{0}  {1:g} kg {2}</translation>
    </message>
    <message>
        <source>Keep it; it holds from the next start of the rig</source>
        <translation>Behalten; gilt ab dem nächsten Start des Prüfstands</translation>
    </message>
    <message>
        <source>Every step wants its reading, and nothing may speak against the result</source>
        <translation>Jeder Schritt braucht seinen Wert, und nichts darf gegen das Ergebnis sprechen</translation>
    </message>
</context>
<context>
    <name>TrendPlot</name>
    <message>
        <source>Pressure</source>
        <translation>Druck</translation>
    </message>
    <message>
        <source>Torque</source>
        <translation>Moment</translation>
    </message>
    <message>
        <source>Speed</source>
        <translation>Drehzahl</translation>
    </message>
    <message>
        <source>Temperature</source>
        <translation>Temperatur</translation>
    </message>
    <message>
        <source>Friction coefficient µ</source>
        <translation>Reibwert µ</translation>
    </message>
    <message>
        <source>No signals yet. They appear when a rig is running.</source>
        <translation>Noch keine Signale. Sie erscheinen, wenn ein Prüfstand läuft.</translation>
    </message>
    <message>
        <source>Rig time (h:mm:ss)</source>
        <translation>Prüfstandszeit (h:mm:ss)</translation>
    </message>
</context>
<context>
    <name>TrendRow</name>
    <message>
        <source>set {0}</source>
        <translation>Soll {0}</translation>
    </message>
</context>
<context>
    <name>ValuesTable</name>
    <message>
        <source>Cut</source>
        <translation>Ausschneiden</translation>
    </message>
    <message>
        <source>Copy</source>
        <translation>Kopieren</translation>
    </message>
    <message>
        <source>Paste</source>
        <translation>Einfügen</translation>
    </message>
    <message>
        <source>Delete rows</source>
        <translation>Zeilen löschen</translation>
    </message>
    <message>
        <source>Insert a row above</source>
        <translation>Zeile darüber einfügen</translation>
    </message>
    <message>
        <source>Reverse the order</source>
        <translation>Reihenfolge umkehren</translation>
    </message>
    <message>
        <source>Join with the row above (+)</source>
        <translation>Mit der Zeile darüber verbinden (+)</translation>
    </message>
</context>
<context>
    <name>VerbRow</name>
    <message>
        <source>&amp;Pause now</source>
        <translation>&amp;Pause jetzt</translation>
    </message>
    <message>
        <source>&amp;Hold after this</source>
        <translation>Danach &amp;halten</translation>
    </message>
    <message>
        <source>&amp;Go on</source>
        <translation>&amp;Weiter</translation>
    </message>
    <message>
        <source>S&amp;kip</source>
        <translation>Ü&amp;berspringen</translation>
    </message>
    <message>
        <source>R&amp;epeat</source>
        <translation>Wiede&amp;rholen</translation>
    </message>
    <message>
        <source>&amp;Abort…</source>
        <translation>Been&amp;den…</translation>
    </message>
    <message>
        <source>&amp;Take command</source>
        <translation>Komm&amp;ando übernehmen</translation>
    </message>
    <message>
        <source>Command from this window; whoever commands now is told</source>
        <translation>Von diesem Fenster aus befehlen; wer jetzt befiehlt, wird benachrichtigt</translation>
    </message>
    <message>
        <source>Noise</source>
        <translation>Geräusch</translation>
    </message>
    <message>
        <source>&amp;Note  (N)</source>
        <translation>&amp;Notiz  (N)</translation>
    </message>
    <message>
        <source>A note with the time, stored with the present braking</source>
        <translation>Eine Notiz mit Uhrzeit, mit der laufenden Bremsung gespeichert</translation>
    </message>
    <message>
        <source>Abort the run</source>
        <translation>Lauf beenden</translation>
    </message>
    <message>
        <source>Write</source>
        <translation>Schreiben</translation>
    </message>
    <message>
        <source>Put it into the journal (Enter)</source>
        <translation>Ins Journal schreiben (Enter)</translation>
    </message>
    <message>
        <source>▸ Will hold</source>
        <translation>▸ Hält danach</translation>
    </message>
    <message>
        <source>Note on the present braking; it goes into the journal with the time.</source>
        <translation>Notiz zur laufenden Bremsung; sie kommt mit Uhrzeit ins Journal.</translation>
    </message>
    <message>
        <source>e.g. groan at the end, smell of pad</source>
        <translation>z. B. Knarzen am Ende, Belaggeruch</translation>
    </message>
</context>
<context>
    <name>WaveformPlot</name>
    <message>
        <source>Sound pressure (Pa)</source>
        <translation>Schalldruck (Pa)</translation>
    </message>
    <message>
        <source>peak {0}</source>
        <translation>Spitze {0}</translation>
    </message>
</context>
<context>
    <name>WindowTab</name>
    <message>
        <source>Lan&amp;guage</source>
        <translation>&amp;Sprache</translation>
    </message>
    <message>
        <source>Of all texts; numbers keep the decimal point</source>
        <translation>Aller Texte; Zahlen behalten den Dezimalpunkt</translation>
    </message>
    <message>
        <source>Look</source>
        <translation>Darstellung</translation>
    </message>
    <message>
        <source>Light for bright rooms, dark for the control room at night</source>
        <translation>Hell für helle Räume, dunkel für die Warte bei Nacht</translation>
    </message>
    <message>
        <source>&amp;Size of text</source>
        <translation>Sch&amp;riftgröße</translation>
    </message>
    <message>
        <source>Also Ctrl + and Ctrl −; Ctrl 0 is 100 %</source>
        <translation>Auch Strg + und Strg −; Strg 0 ist 100 %</translation>
    </message>
    <message>
        <source>Data &amp;folder</source>
        <translation>&amp;Datenordner</translation>
    </message>
    <message>
        <source>Where campaigns and calibrations are kept</source>
        <translation>Wo Kampagnen und Kalibrierungen liegen</translation>
    </message>
    <message>
        <source>This window</source>
        <translation>Dieses Fenster</translation>
    </message>
    <message>
        <source>&amp;light</source>
        <translation>&amp;hell</translation>
    </message>
    <message>
        <source>&amp;dark</source>
        <translation>d&amp;unkel</translation>
    </message>
    <message>
        <source>&amp;Choose …</source>
        <translation>&amp;Wählen …</translation>
    </message>
    <message>
        <source>Choose another folder</source>
        <translation>Einen anderen Ordner wählen</translation>
    </message>
    <message>
        <source>The language changes when the window is started again; the rig goes on.</source>
        <translation>Die Sprache wechselt beim nächsten Start des Fensters; der Prüfstand läuft weiter.</translation>
    </message>
    <message>
        <source>Data folder</source>
        <translation>Datenordner</translation>
    </message>
    <message>
        <source>Give the whole path of a folder, from the root on.</source>
        <translation>Den ganzen Pfad eines Ordners angeben, von der Wurzel an.</translation>
    </message>
    <message>
        <source>This is a file. Give a folder.</source>
        <translation>Das ist eine Datei. Einen Ordner angeben.</translation>
    </message>
    <message>
        <source>There is no folder {0}. Make it first.</source>
        <translation>Es gibt keinen Ordner {0}. Ihn zuerst anlegen.</translation>
    </message>
    <message>
        <source>The data folder changes when the window is started again.</source>
        <translation>Der Datenordner wechselt beim nächsten Start des Fensters.</translation>
    </message>
</context>
<context>
    <name>Workbench</name>
    <message>
        <source>The program has no sequence.
Add one on the left.</source>
        <translation>Das Programm hat keine Sequenz.
Links eine hinzufügen.</translation>
    </message>
</context>
<context>
    <name>_Head</name>
    <message>
        <source>Name of the sequence; the data are filed under it</source>
        <translation>Name der Sequenz; die Daten werden darunter abgelegt</translation>
    </message>
    <message>
        <source>How many times the whole sequence is run</source>
        <translation>Wie oft die ganze Sequenz läuft</translation>
    </message>
    <message>
        <source>What the brakings are for; the evaluation looks at it</source>
        <translation>Wozu die Bremsungen dienen; die Auswertung achtet darauf</translation>
    </message>
    <message>
        <source>run it</source>
        <translation>abarbeiten</translation>
    </message>
    <message>
        <source>A sequence that is off stays in the program and is left out of the run</source>
        <translation>Eine ausgeschaltete Sequenz bleibt im Programm und wird im Lauf ausgelassen</translation>
    </message>
    <message>
        <source>&amp;Name</source>
        <translation>&amp;Name</translation>
    </message>
    <message>
        <source>Ro&amp;le</source>
        <translation>Ro&amp;lle</translation>
    </message>
    <message>
        <source>&amp;Repeat</source>
        <translation>&amp;Wiederholungen</translation>
    </message>
    <message>
        <source>Run it</source>
        <translation>Abarbeiten</translation>
    </message>
</context>
<context>
    <name>_LevelScale</name>
    <message>
        <source>no squeal</source>
        <translation>kein Quietschen</translation>
    </message>
    <message>
        <source>squeal</source>
        <translation>Quietschen</translation>
    </message>
</context>
<context>
    <name>alarms</name>
    <message>
        <source>Only {0} GB of disk are left.</source>
        <translation>Nur noch {0} GB auf der Platte frei.</translation>
    </message>
    <message>
        <source>Free some space before the next braking.</source>
        <translation>Vor der nächsten Bremsung Platz schaffen.</translation>
    </message>
    <message>
        <source>Further cause: {0}</source>
        <translation>Weitere Ursache: {0}</translation>
    </message>
    <message>
        <source>{0} was refused: {1}</source>
        <translation>{0} wurde abgelehnt: {1}</translation>
    </message>
    <message>
        <source>Braking {0} was broken off: {1}</source>
        <translation>Bremsung {0} wurde abgebrochen: {1}</translation>
    </message>
    <message>
        <source>It can be repeated on the Run page.</source>
        <translation>Auf der Seite Lauf lässt sie sich wiederholen.</translation>
    </message>
    <message>
        <source>Braking {0} was not recorded: {1}</source>
        <translation>Bremsung {0} wurde nicht aufgezeichnet: {1}</translation>
    </message>
    <message>
        <source>See the disk and logs/recorder.log.</source>
        <translation>Platte und logs/recorder.log ansehen.</translation>
    </message>
    <message>
        <source>The run has failed: {0}</source>
        <translation>Der Lauf ist fehlgeschlagen: {0}</translation>
    </message>
    <message>
        <source>See the logs.</source>
        <translation>Die Protokolle (logs) ansehen.</translation>
    </message>
    <message>
        <source>Arming</source>
        <translation>Scharfschalten</translation>
    </message>
    <message>
        <source>Disarming</source>
        <translation>Entschärfen</translation>
    </message>
    <message>
        <source>The reset</source>
        <translation>Das Rücksetzen</translation>
    </message>
    <message>
        <source>A second controller</source>
        <translation>Eine zweite Steuerung</translation>
    </message>
    <message>
        <source>A message to the watchdog</source>
        <translation>Eine Nachricht an den Wächter</translation>
    </message>
    <message>
        <source>A sample of the safety channel</source>
        <translation>Ein Wert des Sicherheitskanals</translation>
    </message>
    <message>
        <source>The safe state is not confirmed</source>
        <translation>Der sichere Zustand ist nicht bestätigt</translation>
    </message>
    <message>
        <source>Do not go near the rig; look at pressure and speed there.</source>
        <translation>Nicht an den Prüfstand treten; Druck und Drehzahl dort ansehen.</translation>
    </message>
    <message>
        <source>The safety channel has gone</source>
        <translation>Der Sicherheitskanal ist weg</translation>
    </message>
    <message>
        <source>See logs/rig.log and the cables.</source>
        <translation>logs/rig.log und die Kabel ansehen.</translation>
    </message>
    <message>
        <source>The rig is not at rest after the trip</source>
        <translation>Der Prüfstand steht nach der Auslösung nicht still</translation>
    </message>
    <message>
        <source>Do not go near it; press the emergency stop.</source>
        <translation>Nicht herantreten; Not-Halt drücken.</translation>
    </message>
    <message>
        <source>The rig was lost after the trip</source>
        <translation>Der Prüfstand ging nach der Auslösung verloren</translation>
    </message>
    <message>
        <source>See logs.</source>
        <translation>Die Protokolle (logs) ansehen.</translation>
    </message>
    <message>
        <source>The rig could not be run down</source>
        <translation>Der Prüfstand ließ sich nicht herunterfahren</translation>
    </message>
    <message>
        <source>The relay has dropped; look at pressure and speed there.</source>
        <translation>Das Relais ist abgefallen; Druck und Drehzahl dort ansehen.</translation>
    </message>
    <message>
        <source>The recorder has gone</source>
        <translation>Der Rekorder ist weg</translation>
    </message>
    <message>
        <source>See logs/recorder.log.</source>
        <translation>logs/recorder.log ansehen.</translation>
    </message>
    <message>
        <source>The controller has failed</source>
        <translation>Die Steuerung ist ausgefallen</translation>
    </message>
    <message>
        <source>See logs/controller.log.</source>
        <translation>logs/controller.log ansehen.</translation>
    </message>
    <message>
        <source>A manual command has failed</source>
        <translation>Ein Handbefehl schlug fehl</translation>
    </message>
    <message>
        <source>Nobody commanded: the rig was run down</source>
        <translation>Niemand hat befohlen: der Prüfstand wurde heruntergefahren</translation>
    </message>
    <message>
        <source>Take command.</source>
        <translation>Kommando übernehmen.</translation>
    </message>
    <message>
        <source>Brake pressure</source>
        <translation>Bremsdruck</translation>
    </message>
    <message>
        <source>Speed</source>
        <translation>Drehzahl</translation>
    </message>
    <message>
        <source>Torque</source>
        <translation>Moment</translation>
    </message>
    <message>
        <source>Disc temperature</source>
        <translation>Scheibentemperatur</translation>
    </message>
    <message>
        <source>Friction power</source>
        <translation>Reibleistung</translation>
    </message>
    <message>
        <source>{0} {1} is near its limit {2}.</source>
        <translation>{0} {1} liegt nahe am Grenzwert {2}.</translation>
    </message>
    <message>
        <source>At the limit the watchdog trips: take some load off.</source>
        <translation>Am Grenzwert löst der Wächter aus: Last wegnehmen.</translation>
    </message>
</context>
<context>
    <name>calibrations</name>
    <message>
        <source>{0}, gain {1:.4f}, offset {2:+.2f} K</source>
        <translation>{0}, Faktor {1:.4f}, Versatz {2:+.2f} K</translation>
    </message>
    <message>
        <source>{0:.5f} mPa/count, gain {1:.4f}</source>
        <translation>{0:.5f} mPa je Zähler, Faktor {1:.4f}</translation>
    </message>
    <message>
        <source>gain {0:.5f}, offset {1:+.2f} {2}</source>
        <translation>Faktor {0:.5f}, Versatz {1:+.2f} {2}</translation>
    </message>
    <message>
        <source>{0}; valid until {1}</source>
        <translation>{0}; gültig bis {1}</translation>
    </message>
    <message>
        <source>sensor</source>
        <translation>Sensor</translation>
    </message>
    <message>
        <source>reference</source>
        <translation>Normal</translation>
    </message>
    <message>
        <source>note</source>
        <translation>Notiz</translation>
    </message>
    <message>
        <source>{0} readings; {1}</source>
        <translation>{0} Ablesungen; {1}</translation>
    </message>
    <message>
        <source>largest residual {0} % of full scale, allowed {1} %</source>
        <translation>größte Restabweichung {0} % vom Endwert, erlaubt {1} %</translation>
    </message>
    <message>
        <source>Repeat the point that stands out; check lever length and masses.</source>
        <translation>Den auffälligen Punkt wiederholen; Hebellänge und Massen prüfen.</translation>
    </message>
    <message>
        <source>hysteresis {0} % of full scale, allowed {1} %</source>
        <translation>Hysterese {0} % vom Endwert, erlaubt {1} %</translation>
    </message>
    <message>
        <source>Something rubs or is loose: check lever bearing and sensor mounting.</source>
        <translation>Etwas reibt oder ist lose: Hebellager und Sensorbefestigung prüfen.</translation>
    </message>
    <message>
        <source>the zero does not come back; it differs by {0} % of full scale, allowed {1} %</source>
        <translation>der Nullpunkt kommt nicht zurück; er weicht um {0} % vom Endwert ab, erlaubt {1} %</translation>
    </message>
    <message>
        <source>Let the chain warm up; check that the lever hangs free.</source>
        <translation>Messkette warm werden lassen; prüfen, dass der Hebel frei hängt.</translation>
    </message>
    <message>
        <source>scatter of a reading {0} % of full scale, allowed {1} %</source>
        <translation>Streuung einer Ablesung {0} % vom Endwert, erlaubt {1} %</translation>
    </message>
    <message>
        <source>Wait until the weights hang still; switch the ventilator off.</source>
        <translation>Warten, bis die Gewichte still hängen; Lüfter ausschalten.</translation>
    </message>
    <message>
        <source>only one direction of rotation was measured</source>
        <translation>nur eine Drehrichtung wurde gemessen</translation>
    </message>
    <message>
        <source>Load the other side too.</source>
        <translation>Auch die andere Seite belasten.</translation>
    </message>
    <message>
        <source>the two directions differ by {0} %, allowed {1} %</source>
        <translation>die zwei Richtungen unterscheiden sich um {0} %, erlaubt {1} %</translation>
    </message>
    <message>
        <source>Check that the lever is level on both sides and its length the same.</source>
        <translation>Prüfen, dass der Hebel auf beiden Seiten waagrecht und gleich lang ist.</translation>
    </message>
    <message>
        <source>the gain {0} is more than {1} % off</source>
        <translation>der Faktor {0} liegt um mehr als {1} % daneben</translation>
    </message>
    <message>
        <source>Check lever length and masses; then the scale of the channel in the rig file.</source>
        <translation>Hebellänge und Massen prüfen; dann die Skala des Kanals in der Prüfstandsdatei.</translation>
    </message>
    <message>
        <source>the largest load is only {0} % of full scale</source>
        <translation>die größte Last ist nur {0} % vom Endwert</translation>
    </message>
    <message>
        <source>Load to {0} % at least, better to the torque of the tests.</source>
        <translation>Bis mindestens {0} % belasten, besser bis zum Moment der Prüfungen.</translation>
    </message>
    <message>
        <source>the shaft turns with {0} 1/min: bring the rig to rest</source>
        <translation>die Welle dreht mit {0} 1/min: Prüfstand zum Stillstand bringen</translation>
    </message>
    <message>
        <source>the brake is pressed with {0} bar: release it</source>
        <translation>die Bremse ist mit {0} bar angelegt: lösen</translation>
    </message>
    <message>
        <source>the levels disagree by {0} dB, allowed {1} dB</source>
        <translation>die Pegel weichen um {0} dB voneinander ab, erlaubt {1} dB</translation>
    </message>
    <message>
        <source>Seat the calibrator again; check the gain of the amplifier.</source>
        <translation>Kalibrator neu aufsetzen; Verstärkung prüfen.</translation>
    </message>
    <message>
        <source>the sensitivity has changed by {0} dB since the last calibration</source>
        <translation>die Empfindlichkeit hat sich seit der letzten Kalibrierung um {0} dB geändert</translation>
    </message>
    <message>
        <source>Seat the calibrator again; when it stays so, the microphone may be damaged.</source>
        <translation>Kalibrator neu aufsetzen; bleibt es so, ist das Mikrofon vielleicht beschädigt.</translation>
    </message>
    <message>
        <source>the chain is {0} dB off its nominal sensitivity</source>
        <translation>die Messkette liegt {0} dB neben ihrer Nennempfindlichkeit</translation>
    </message>
    <message>
        <source>Check the level set at the calibrator and the gain of the amplifier.</source>
        <translation>Eingestellten Pegel des Kalibrators und Verstärkung prüfen.</translation>
    </message>
    <message>
        <source>at {0} dB: the converter is at its limit</source>
        <translation>bei {0} dB: der Wandler ist an seiner Grenze</translation>
    </message>
    <message>
        <source>Lower the gain, or use 94 dB.</source>
        <translation>Verstärkung senken, oder 94 dB benutzen.</translation>
    </message>
    <message>
        <source>at {0} dB: the loudest tone is at {1} Hz, not at 1 kHz</source>
        <translation>bei {0} dB: der lauteste Ton liegt bei {1} Hz, nicht bei 1 kHz</translation>
    </message>
    <message>
        <source>Switch the calibrator on and push it on to its stop.</source>
        <translation>Kalibrator einschalten und bis zum Anschlag aufschieben.</translation>
    </message>
    <message>
        <source>at {0} dB: the tone is only {1} dB above the rest</source>
        <translation>bei {0} dB: der Ton liegt nur {1} dB über dem Rest</translation>
    </message>
    <message>
        <source>Push the calibrator on to its stop; switch the ventilator off.</source>
        <translation>Kalibrator bis zum Anschlag aufschieben; Lüfter ausschalten.</translation>
    </message>
    <message>
        <source>at {0} dB: the level moves by {1} dB</source>
        <translation>bei {0} dB: der Pegel schwankt um {1} dB</translation>
    </message>
    <message>
        <source>Wait until the tone is steady; check the battery of the calibrator.</source>
        <translation>Warten, bis der Ton ruhig ist; Batterie des Kalibrators prüfen.</translation>
    </message>
    <message>
        <source>an emissivity of {0} is not likely</source>
        <translation>ein Emissionsgrad von {0} ist unwahrscheinlich</translation>
    </message>
    <message>
        <source>Both must look at the same place; wait until the contact thermometer is steady.</source>
        <translation>Beide müssen dieselbe Stelle sehen; warten, bis das Kontaktthermometer ruhig ist.</translation>
    </message>
    <message>
        <source>the pairs disagree by {0} K after correction</source>
        <translation>die Paare weichen nach der Korrektur um {0} K ab</translation>
    </message>
    <message>
        <source>Repeat the pair that stands out, with a steady temperature.</source>
        <translation>Das auffällige Paar bei ruhiger Temperatur wiederholen.</translation>
    </message>
    <message>
        <source>there is one pair only</source>
        <translation>es gibt nur ein Paar</translation>
    </message>
    <message>
        <source>A second one, 100 K higher, shows errors.</source>
        <translation>Ein zweites, 100 K höher, zeigt Fehler.</translation>
    </message>
    <message>
        <source>the disc must be {0} K warmer than its surroundings: the emissivity cannot be seen below</source>
        <translation>die Scheibe muss {0} K wärmer sein als ihre Umgebung: darunter ist der Emissionsgrad nicht zu erkennen</translation>
    </message>
    <message>
        <source>the masses must rise and be above zero: give them from light to heavy</source>
        <translation>die Massen müssen steigen und über null liegen: von leicht nach schwer angeben</translation>
    </message>
    <message>
        <source>three different loads are needed for a line and its residuals</source>
        <translation>für eine Gerade und ihre Restabweichungen braucht es drei verschiedene Lasten</translation>
    </message>
    <message>
        <source>the reading does not rise with the torque: check the sign of the channel</source>
        <translation>die Ablesung steigt nicht mit dem Moment: Vorzeichen des Kanals prüfen</translation>
    </message>
    <message>
        <source>no recording of a calibrator yet</source>
        <translation>noch keine Aufzeichnung eines Kalibrators</translation>
    </message>
</context>
<context>
    <name>checks</name>
    <message>
        <source>{0} is not from {1} to {2}</source>
        <translation>{0} liegt nicht zwischen {1} und {2}</translation>
    </message>
    <message>
        <source>{0} is not above {1} and up to {2}</source>
        <translation>{0} liegt nicht über {1} und bis {2}</translation>
    </message>
    <message>
        <source>{0} is not a number that can be set</source>
        <translation>{0} ist keine einstellbare Zahl</translation>
    </message>
    <message>
        <source>give a whole number of 1 or more</source>
        <translation>eine ganze Zahl ab 1 angeben</translation>
    </message>
    <message>
        <source>give a whole number of 0 or more</source>
        <translation>eine ganze Zahl ab 0 angeben</translation>
    </message>
    <message>
        <source>give a whole number of 1 or more, e.g. {0}</source>
        <translation>eine ganze Zahl ab 1 angeben, z. B. {0}</translation>
    </message>
    <message>
        <source>give the sampling rate in Hz, e.g. {0}</source>
        <translation>die Abtastrate in Hz angeben, z. B. {0}</translation>
    </message>
    <message>
        <source>give a time in seconds from {0} to {1}, e.g. {2}</source>
        <translation>eine Zeit in Sekunden von {0} bis {1} angeben, z. B. {2}</translation>
    </message>
    <message>
        <source>give the duration in seconds, at most one hour</source>
        <translation>die Dauer in Sekunden angeben, höchstens eine Stunde</translation>
    </message>
    <message>
        <source>give a time in seconds, 0 or more, at most one day</source>
        <translation>eine Zeit in Sekunden ab 0 angeben, höchstens einen Tag</translation>
    </message>
    <message>
        <source>give a time in seconds, at most one day</source>
        <translation>eine Zeit in Sekunden angeben, höchstens einen Tag</translation>
    </message>
    <message>
        <source>give the disc speed in 1/min; negative is the reverse direction</source>
        <translation>die Drehzahl der Scheibe in 1/min angeben; negativ ist rückwärts</translation>
    </message>
    <message>
        <source>give the brake pressure in bar, 0 or more</source>
        <translation>den Bremsdruck in bar angeben, ab 0</translation>
    </message>
    <message>
        <source>give the pressure offset from the working point in bar</source>
        <translation>den Abstand vom Arbeitspunkt in bar angeben</translation>
    </message>
    <message>
        <source>give the amplitude in bar, 0 or more; 0 is &apos;constant&apos;</source>
        <translation>die Amplitude in bar angeben, ab 0; 0 ist &apos;konstant&apos;</translation>
    </message>
    <message>
        <source>give the frequency of the pressure function in Hz, e.g. {0}</source>
        <translation>die Frequenz des Druckverlaufs in Hz angeben, z. B. {0}</translation>
    </message>
    <message>
        <source>give the disc temperature in degrees Celsius (0 K is {0})</source>
        <translation>die Scheibentemperatur in Grad Celsius angeben (0 K ist {0})</translation>
    </message>
    <message>
        <source>give the half width of the band in kelvin, e.g. {0}</source>
        <translation>die halbe Breite des Bandes in Kelvin angeben, z. B. {0}</translation>
    </message>
    <message>
        <source>dragging at {0} does not heat</source>
        <translation>Schleifen bei {0} heizt nicht</translation>
    </message>
    <message>
        <source>leave out drag_speed_rpm and drag_pressure_bar to use the rig&apos;s own, or give values above 0</source>
        <translation>Schleifdrehzahl und Schleifdruck leer lassen für die des Prüfstands, oder Werte über 0 angeben</translation>
    </message>
    <message>
        <source>max_degc = {0} is below cool_down_degc = {1}</source>
        <translation>Maximaltemperatur {0} liegt unter Abkühltemperatur {1}</translation>
    </message>
    <message>
        <source>let the cool-down temperature be the lower one, e.g. max_degc = {0}, cool_down_degc = {1}</source>
        <translation>die Abkühltemperatur muss die kleinere sein, z. B. Maximaltemperatur {0}, Abkühltemperatur {1}</translation>
    </message>
    <message>
        <source>channel {0} is listed twice</source>
        <translation>Kanal {0} ist doppelt aufgeführt</translation>
    </message>
    <message>
        <source>remove one of them</source>
        <translation>einen davon entfernen</translation>
    </message>
    <message>
        <source>the segments last {0} s together</source>
        <translation>die Abschnitte dauern zusammen {0} s</translation>
    </message>
    <message>
        <source>shorten the braking to at most {0} s</source>
        <translation>die Bremsung auf höchstens {0} s kürzen</translation>
    </message>
    <message>
        <source>the speed jumps by {0} 1/min after segment {1}</source>
        <translation>die Drehzahl springt nach Abschnitt {1} um {0} 1/min</translation>
    </message>
    <message>
        <source>let the next segment start where the last one ends, or put a ramp between them</source>
        <translation>den nächsten Abschnitt beginnen, wo der letzte endet, oder eine Rampe dazwischen setzen</translation>
    </message>
    <message>
        <source>{0} brakings are more than {1}</source>
        <translation>{0} Bremsungen sind mehr als {1}</translation>
    </message>
    <message>
        <source>shorten the lists or the repetition; split the work into several programs</source>
        <translation>Listen oder Wiederholungen kürzen; auf mehrere Programme aufteilen</translation>
    </message>
    <message>
        <source>split the work into several programs</source>
        <translation>auf mehrere Programme aufteilen</translation>
    </message>
    <message>
        <source>temperatures_degc: {0} degC is above limits.max_degc = {1}</source>
        <translation>Temperaturen: {0} °C liegt über der Maximaltemperatur {1}</translation>
    </message>
    <message>
        <source>lower the temperature, or raise limits.max_degc if brake and rig allow it</source>
        <translation>Temperatur senken, oder die Maximaltemperatur anheben, wenn Bremse und Prüfstand es erlauben</translation>
    </message>
    <message>
        <source>pressures_bar: the working point {0} bar less the amplitude is {1} bar</source>
        <translation>Drücke: Arbeitspunkt {0} bar weniger Amplitude ist {1} bar</translation>
    </message>
    <message>
        <source>raise the working point or reduce the amplitude: the pressure cannot be negative</source>
        <translation>Arbeitspunkt anheben oder Amplitude verkleinern: der Druck kann nicht negativ sein</translation>
    </message>
    <message>
        <source>pressure_function.rise_s = {0} is not shorter than the braking of {1} s</source>
        <translation>Anstiegszeit {0} ist nicht kürzer als die Bremsung von {1} s</translation>
    </message>
    <message>
        <source>shorten rise_s or lengthen the braking</source>
        <translation>Anstiegszeit kürzen oder Bremsung verlängern</translation>
    </message>
    <message>
        <source>two sequences are called {0}</source>
        <translation>zwei Sequenzen heißen {0}</translation>
    </message>
    <message>
        <source>give each sequence its own name (capitals do not distinguish)</source>
        <translation>jeder Sequenz einen eigenen Namen geben (Groß und Klein zählt nicht)</translation>
    </message>
    <message>
        <source>{0} the conditioning drag does not heat the disc to this temperature</source>
        <translation>{0}: das Schleifen heizt die Scheibe nicht auf diese Temperatur</translation>
    </message>
    <message>
        <source>raise conditioning.drag_pressure_bar or drag_speed_rpm, or lower the temperature</source>
        <translation>Schleifdruck oder Schleifdrehzahl erhöhen, oder Temperatur senken</translation>
    </message>
    <message>
        <source>{0} conditioning is expected to take longer than its time-out</source>
        <translation>{0}: die Konditionierung dauert voraussichtlich länger als ihr Zeitlimit</translation>
    </message>
    <message>
        <source>raise conditioning.timeout_s, or choose a loop order with smaller temperature steps</source>
        <translation>Zeitlimit erhöhen, oder eine Schleifenfolge mit kleineren Temperaturschritten wählen</translation>
    </message>
    <message>
        <source>{0} the braking is expected to heat the disc above this limit, and would be cut short</source>
        <translation>{0}: die Bremsung heizt die Scheibe voraussichtlich darüber und würde vorzeitig enden</translation>
    </message>
    <message>
        <source>start cooler, or brake shorter or with less pressure</source>
        <translation>kälter beginnen, kürzer oder mit weniger Druck bremsen</translation>
    </message>
    <message>
        <source>{0} is above the {1} degC the rig allows for the disc</source>
        <translation>{0} liegt über den {1} °C, die der Prüfstand der Scheibe erlaubt</translation>
    </message>
    <message>
        <source>set limits.max_degc to {0} or less</source>
        <translation>Maximaltemperatur auf höchstens {0} setzen</translation>
    </message>
    <message>
        <source>use start temperatures up to {0} degC</source>
        <translation>Starttemperaturen bis {0} °C benutzen</translation>
    </message>
    <message>
        <source>{0} is not reached by cooling with air of {1} degC</source>
        <translation>{0} wird durch Kühlen mit Luft von {1} °C nicht erreicht</translation>
    </message>
    <message>
        <source>use start temperatures from {0} degC</source>
        <translation>Starttemperaturen ab {0} °C benutzen</translation>
    </message>
    <message>
        <source>{0} is not within {1} to {2} 1/min of the drive</source>
        <translation>{0} liegt nicht in {1} bis {2} 1/min des Antriebs</translation>
    </message>
    <message>
        <source>leave it out to use the rig&apos;s own {0}</source>
        <translation>leer lassen für {0} des Prüfstands</translation>
    </message>
    <message>
        <source>{0} is not within {1} to {2} bar of the actuator</source>
        <translation>{0} liegt nicht in {1} bis {2} bar des Aktors</translation>
    </message>
    <message>
        <source>{0} is above the {1} 1/min of the drive</source>
        <translation>{0} liegt über den {1} 1/min des Antriebs</translation>
    </message>
    <message>
        <source>use speeds up to {0} 1/min</source>
        <translation>Drehzahlen bis {0} 1/min benutzen</translation>
    </message>
    <message>
        <source>{0} is the reverse direction, which this drive does not run</source>
        <translation>{0} ist rückwärts, das kann dieser Antrieb nicht</translation>
    </message>
    <message>
        <source>{0} is below the {1} 1/min of the drive in reverse</source>
        <translation>{0} liegt unter den {1} 1/min des Antriebs rückwärts</translation>
    </message>
    <message>
        <source>use speeds from {0} 1/min</source>
        <translation>Drehzahlen ab {0} 1/min benutzen</translation>
    </message>
    <message>
        <source>{0} is steeper than the drive&apos;s ramp of {1} 1/min per s</source>
        <translation>{0} ist steiler als die Rampe des Antriebs von {1} 1/min je s</translation>
    </message>
    <message>
        <source>lengthen the segment, or reduce the difference of its two speeds</source>
        <translation>Abschnitt verlängern, oder den Unterschied seiner zwei Drehzahlen verkleinern</translation>
    </message>
    <message>
        <source>{0} is above the {1} bar of the actuator (working point plus amplitude)</source>
        <translation>{0} liegt über den {1} bar des Aktors (Arbeitspunkt plus Amplitude)</translation>
    </message>
    <message>
        <source>keep working point plus amplitude at {0} bar or less</source>
        <translation>Arbeitspunkt plus Amplitude höchstens {0} bar</translation>
    </message>
    <message>
        <source>{0} is below {1} bar, the lowest pressure the actuator can hold</source>
        <translation>{0} liegt unter {1} bar, dem kleinsten Druck, den der Aktor halten kann</translation>
    </message>
    <message>
        <source>use 0, or at least {0} bar after subtracting the amplitude</source>
        <translation>0 benutzen, oder nach Abzug der Amplitude mindestens {0} bar</translation>
    </message>
    <message>
        <source>{0} is faster than the actuator&apos;s {1} bar/s</source>
        <translation>{0} ist schneller als die {1} bar/s des Aktors</translation>
    </message>
    <message>
        <source>lower amplitude or frequency, or lengthen rise_s or the braking</source>
        <translation>Amplitude oder Frequenz senken, oder Anstiegszeit oder Bremsung verlängern</translation>
    </message>
    <message>
        <source>{0} of possible brake torque are above the {1} N·m of the drive</source>
        <translation>{0} mögliches Bremsmoment liegen über den {1} N·m des Antriebs</translation>
    </message>
    <message>
        <source>use at most {0} bar</source>
        <translation>höchstens {0} bar benutzen</translation>
    </message>
    <message>
        <source>{0} of possible brake power are above the {1} kW of the drive</source>
        <translation>{0} mögliche Bremsleistung liegen über den {1} kW des Antriebs</translation>
    </message>
    <message>
        <source>reduce the speed or the pressure</source>
        <translation>Drehzahl oder Druck senken</translation>
    </message>
    <message>
        <source>{0} is no channel of this rig</source>
        <translation>{0} ist kein Kanal dieses Prüfstands</translation>
    </message>
    <message>
        <source>choose from: {0}</source>
        <translation>wählen aus: {0}</translation>
    </message>
    <message>
        <source>{0} is a sound channel and would record the ventilator</source>
        <translation>{0} ist ein Schallkanal und würde den Lüfter aufzeichnen</translation>
    </message>
    <message>
        <source>set ventilator = false, or remove the channel from recording.channels</source>
        <translation>Lüfter beim Bremsen ausschalten, oder den Kanal aus der Aufzeichnung nehmen</translation>
    </message>
    <message>
        <source>{0} at {1} Hz cannot be stored at this rate: it is not the channel&apos;s own rate divided by a whole number</source>
        <translation>{0} mit {1} Hz lässt sich so nicht speichern: die Rate ist nicht die des Kanals geteilt durch eine ganze Zahl</translation>
    </message>
    <message>
        <source>&apos;{0}&apos; is sampled at {1} Hz: choose sampling_hz and decimation so that sampling_hz / decimation is {2} ... Hz</source>
        <translation>&apos;{0}&apos; wird mit {1} Hz abgetastet: Abtastrate und Dezimierung so wählen, dass ihr Quotient {2} ... Hz ist</translation>
    </message>
</context>
<context>
    <name>data-columns</name>
    <message>
        <source>complete</source>
        <translation>vollständig</translation>
    </message>
    <message>
        <source>incomplete</source>
        <translation>unvollständig</translation>
    </message>
    <message>
        <source>recovered</source>
        <translation>gerettet</translation>
    </message>
    <message>
        <source>excluded</source>
        <translation>ausgeschlossen</translation>
    </message>
    <message>
        <source>in the trash</source>
        <translation>im Papierkorb</translation>
    </message>
    <message>
        <source>unreadable</source>
        <translation>unlesbar</translation>
    </message>
    <message>
        <source>bedding</source>
        <translation>Einbremsen</translation>
    </message>
    <message>
        <source>matrix</source>
        <translation>Matrix</translation>
    </message>
    <message>
        <source>check</source>
        <translation>Kontrolle</translation>
    </message>
    <message>
        <source>manual</source>
        <translation>manuell</translation>
    </message>
    <message>
        <source>No.</source>
        <translation>Nr.</translation>
    </message>
    <message>
        <source>Number of the braking in its program</source>
        <translation>Nummer der Bremsung in ihrem Programm</translation>
    </message>
    <message>
        <source>Start</source>
        <translation>Beginn</translation>
    </message>
    <message>
        <source>Time of the first sample by the clock of the rig</source>
        <translation>Zeit des ersten Abtastwerts nach der Uhr des Prüfstands</translation>
    </message>
    <message>
        <source>Sequence</source>
        <translation>Sequenz</translation>
    </message>
    <message>
        <source>Role</source>
        <translation>Rolle</translation>
    </message>
    <message>
        <source>Set p</source>
        <translation>Soll p</translation>
    </message>
    <message>
        <source>Set-point of the brake pressure</source>
        <translation>Sollwert des Bremsdrucks</translation>
    </message>
    <message>
        <source>Set T</source>
        <translation>Soll T</translation>
    </message>
    <message>
        <source>Set-point of the disc temperature</source>
        <translation>Sollwert der Scheibentemperatur</translation>
    </message>
    <message>
        <source>Pressure</source>
        <translation>Druck</translation>
    </message>
    <message>
        <source>Mean brake pressure while the brake was applied</source>
        <translation>Mittlerer Bremsdruck, solange die Bremse angelegt war</translation>
    </message>
    <message>
        <source>Speed</source>
        <translation>Drehzahl</translation>
    </message>
    <message>
        <source>Mean speed of the disc</source>
        <translation>Mittlere Drehzahl der Scheibe</translation>
    </message>
    <message>
        <source>Torque</source>
        <translation>Moment</translation>
    </message>
    <message>
        <source>Mean friction torque</source>
        <translation>Mittleres Reibmoment</translation>
    </message>
    <message>
        <source>Disc, start</source>
        <translation>Scheibe, Beginn</translation>
    </message>
    <message>
        <source>Disc temperature at the start of the brake application</source>
        <translation>Scheibentemperatur beim Anlegen der Bremse</translation>
    </message>
    <message>
        <source>Disc, max</source>
        <translation>Scheibe, max.</translation>
    </message>
    <message>
        <source>Highest disc temperature</source>
        <translation>Höchste Scheibentemperatur</translation>
    </message>
    <message>
        <source>Mean µ</source>
        <translation>µ Mittel</translation>
    </message>
    <message>
        <source>Mean coefficient of friction</source>
        <translation>Mittlerer Reibwert</translation>
    </message>
    <message>
        <source>Std µ</source>
        <translation>Streuung µ</translation>
    </message>
    <message>
        <source>Variation of friction within the braking</source>
        <translation>Schwankung des Reibwerts in der Bremsung</translation>
    </message>
    <message>
        <source>Squeals</source>
        <translation>Ereignisse</translation>
    </message>
    <message>
        <source>Number of squeal events, harmonics left out</source>
        <translation>Anzahl der Quietschereignisse, ohne Obertöne</translation>
    </message>
    <message>
        <source>Squeal</source>
        <translation>Quietsch.</translation>
    </message>
    <message>
        <source>Frequency of the loudest squeal</source>
        <translation>Frequenz des lautesten Quietschens</translation>
    </message>
    <message>
        <source>Level</source>
        <translation>Pegel</translation>
    </message>
    <message>
        <source>Level of the loudest squeal</source>
        <translation>Pegel des lautesten Quietschens</translation>
    </message>
    <message>
        <source>Level A</source>
        <translation>Pegel A</translation>
    </message>
    <message>
        <source>A-weighted level of the loudest squeal</source>
        <translation>A-bewerteter Pegel des lautesten Quietschens</translation>
    </message>
    <message>
        <source>A-weighted equivalent sound level of the braking</source>
        <translation>A-bewerteter äquivalenter Schallpegel der Bremsung</translation>
    </message>
    <message>
        <source>Highest sound level, time weighting Fast</source>
        <translation>Höchster Schallpegel, Zeitbewertung Fast</translation>
    </message>
    <message>
        <source>Rating</source>
        <translation>Note</translation>
    </message>
    <message>
        <source>Subjective noise rating: 1 nothing heard … 9 unbearable</source>
        <translation>Subjektive Geräuschnote: 1 nichts gehört … 9 unerträglich</translation>
    </message>
    <message>
        <source>State</source>
        <translation>Zustand</translation>
    </message>
    <message>
        <source>Only complete brakings that are not excluded count</source>
        <translation>Nur vollständige, nicht ausgeschlossene Bremsungen zählen</translation>
    </message>
    <message>
        <source>Tags</source>
        <translation>Schlagwörter</translation>
    </message>
    <message>
        <source>Note</source>
        <translation>Notiz</translation>
    </message>
    <message>
        <source>Reason of an exclusion, notes, what went wrong</source>
        <translation>Grund des Ausschlusses, Notizen, was schiefging</translation>
    </message>
</context>
<context>
    <name>data-marks</name>
    <message>
        <source>Pressure is applied</source>
        <translation>Druck wird angelegt</translation>
    </message>
    <message>
        <source>Pressure is released</source>
        <translation>Druck wird gelöst</translation>
    </message>
    <message>
        <source>Note</source>
        <translation>Notiz</translation>
    </message>
    <message>
        <source>Noise rating</source>
        <translation>Geräuschnote</translation>
    </message>
</context>
<context>
    <name>data-results</name>
    <message>
        <source>Coefficient of friction, mean</source>
        <translation>Reibwert, Mittel</translation>
    </message>
    <message>
        <source>Coefficient of friction, variation</source>
        <translation>Reibwert, Schwankung</translation>
    </message>
    <message>
        <source>Equivalent level</source>
        <translation>Äquivalenter Pegel</translation>
    </message>
    <message>
        <source>Equivalent level, A-weighted</source>
        <translation>Äquivalenter Pegel, A-bewertet</translation>
    </message>
    <message>
        <source>Highest level (Fast)</source>
        <translation>Höchster Pegel (Fast)</translation>
    </message>
    <message>
        <source>Background level</source>
        <translation>Hintergrundpegel</translation>
    </message>
    <message>
        <source>Clipped samples, share</source>
        <translation>Übersteuerte Abtastwerte, Anteil</translation>
    </message>
    <message>
        <source>Squeal events</source>
        <translation>Quietschereignisse</translation>
    </message>
    <message>
        <source>Loudest squeal, frequency</source>
        <translation>Lautestes Quietschen, Frequenz</translation>
    </message>
    <message>
        <source>Loudest squeal, level</source>
        <translation>Lautestes Quietschen, Pegel</translation>
    </message>
    <message>
        <source>Brake applied from</source>
        <translation>Bremse angelegt von</translation>
    </message>
    <message>
        <source>Brake applied to</source>
        <translation>Bremse angelegt bis</translation>
    </message>
    <message>
        <source>Disc temperature, set-point</source>
        <translation>Scheibentemperatur, Sollwert</translation>
    </message>
    <message>
        <source>Pressure, set-point</source>
        <translation>Druck, Sollwert</translation>
    </message>
    <message>
        <source>Torque</source>
        <translation>Moment</translation>
    </message>
    <message>
        <source>Pressure</source>
        <translation>Druck</translation>
    </message>
    <message>
        <source>Speed</source>
        <translation>Drehzahl</translation>
    </message>
    <message>
        <source>Disc temperature</source>
        <translation>Scheibentemperatur</translation>
    </message>
    <message>
        <source>mean</source>
        <translation>Mittel</translation>
    </message>
    <message>
        <source>variation</source>
        <translation>Schwankung</translation>
    </message>
    <message>
        <source>start</source>
        <translation>Beginn</translation>
    </message>
    <message>
        <source>end</source>
        <translation>Ende</translation>
    </message>
    <message>
        <source>least</source>
        <translation>kleinster</translation>
    </message>
    <message>
        <source>greatest</source>
        <translation>größter</translation>
    </message>
</context>
<context>
    <name>devices</name>
    <message>
        <source>{0} s old</source>
        <translation>{0} s alt</translation>
    </message>
    <message>
        <source>on</source>
        <translation>ein</translation>
    </message>
    <message>
        <source>off</source>
        <translation>aus</translation>
    </message>
    <message>
        <source>closed</source>
        <translation>geschlossen</translation>
    </message>
    <message>
        <source>open</source>
        <translation>offen</translation>
    </message>
    <message>
        <source>speed</source>
        <translation>Drehzahl</translation>
    </message>
    <message>
        <source>set-point</source>
        <translation>Sollwert</translation>
    </message>
    <message>
        <source>torque enable</source>
        <translation>Momentfreigabe</translation>
    </message>
    <message>
        <source>line pressure</source>
        <translation>Leitungsdruck</translation>
    </message>
    <message>
        <source>air</source>
        <translation>Luft</translation>
    </message>
    <message>
        <source>torque</source>
        <translation>Moment</translation>
    </message>
    <message>
        <source>disc</source>
        <translation>Scheibe</translation>
    </message>
    <message>
        <source>relay</source>
        <translation>Relais</translation>
    </message>
    <message>
        <source>not valid</source>
        <translation>ungültig</translation>
    </message>
    <message>
        <source>{0} ms old</source>
        <translation>{0} ms alt</translation>
    </message>
</context>
<context>
    <name>entries</name>
    <message>
        <source>0 or {0}</source>
        <translation>0 oder {0}</translation>
    </message>
    <message>
        <source>Give a number, e.g. {0}.</source>
        <translation>Eine Zahl angeben, z. B. {0}.</translation>
    </message>
    <message>
        <source>The value</source>
        <translation>Der Wert</translation>
    </message>
    <message>
        <source>{0} {1} is above the {2} of this rig. Give {3}.</source>
        <translation>{0} {1} liegt über {2}, der Grenze dieses Prüfstands. {3} angeben.</translation>
    </message>
    <message>
        <source>{0} {1} is below {2}. Give {3}.</source>
        <translation>{0} {1} liegt unter {2}. {3} angeben.</translation>
    </message>
    <message>
        <source>“{0}” is not a number. Give {1}.</source>
        <translation>„{0}“ ist keine Zahl. {1} angeben.</translation>
    </message>
    <message>
        <source>Give a number: {0}.</source>
        <translation>Eine Zahl angeben: {0}.</translation>
    </message>
</context>
<context>
    <name>faults</name>
    <message>
        <source>“{value}” is not a number.</source>
        <translation>„{value}“ ist keine Zahl.</translation>
    </message>
    <message>
        <source>Write for example 12.5, without a unit.</source>
        <translation>Zum Beispiel 12.5 schreiben, ohne Einheit.</translation>
    </message>
    <message>
        <source>“{value}” is not a whole number.</source>
        <translation>„{value}“ ist keine ganze Zahl.</translation>
    </message>
    <message>
        <source>Write for example 3.</source>
        <translation>Zum Beispiel 3 schreiben.</translation>
    </message>
    <message>
        <source>Nothing is entered here.</source>
        <translation>Hier ist nichts eingegeben.</translation>
    </message>
    <message>
        <source>Enter a number.</source>
        <translation>Eine Zahl eingeben.</translation>
    </message>
    <message>
        <source>The list is empty: nothing would be run.</source>
        <translation>Die Liste ist leer: nichts würde laufen.</translation>
    </message>
    <message>
        <source>Enter at least one value.</source>
        <translation>Mindestens einen Wert eingeben.</translation>
    </message>
    <message>
        <source>Enter a temperature, or switch the conditioning off.</source>
        <translation>Eine Temperatur eingeben oder die Konditionierung ausschalten.</translation>
    </message>
    <message>
        <source>The program has no braking to run.</source>
        <translation>Das Programm hat keine Bremsung.</translation>
    </message>
    <message>
        <source>Add a sequence, or switch one on.</source>
        <translation>Eine Sequenz hinzufügen oder einschalten.</translation>
    </message>
    <message>
        <source>A name is missing.</source>
        <translation>Ein Name fehlt.</translation>
    </message>
    <message>
        <source>Use letters, digits, “.”, “_”, “-” or blanks.</source>
        <translation>Buchstaben, Ziffern, „.“, „_“, „-“ oder Leerzeichen benutzen.</translation>
    </message>
    <message>
        <source>{value} cannot be a name.</source>
        <translation>{value} kann kein Name sein.</translation>
    </message>
    <message>
        <source>Use letters, digits, “.”, “_”, “-”, blanks; begin with a letter or digit.</source>
        <translation>Buchstaben, Ziffern, „.“, „_“, „-“, Leerzeichen; mit Buchstabe oder Ziffer beginnen.</translation>
    </message>
    <message>
        <source>No channel is recorded.</source>
        <translation>Kein Kanal wird aufgezeichnet.</translation>
    </message>
    <message>
        <source>Tick at least one.</source>
        <translation>Mindestens einen ankreuzen.</translation>
    </message>
    <message>
        <source>A soak of {value} s leaves no time within the time-out of {timeout_s} s.</source>
        <translation>Eine Haltezeit von {value} s lässt keine Zeit im Zeitlimit von {timeout_s} s.</translation>
    </message>
    <message>
        <source>Raise the time-out or shorten the soak.</source>
        <translation>Zeitlimit erhöhen oder Haltezeit kürzen.</translation>
    </message>
    <message>
        <source>Lists of unequal length cannot be run entry by entry.</source>
        <translation>Ungleich lange Listen lassen sich nicht listenweise abarbeiten.</translation>
    </message>
    <message>
        <source>Make the lists equally long (or of one value), or run all combinations.</source>
        <translation>Listen gleich lang machen (oder mit einem Wert), oder schleifenweise abarbeiten.</translation>
    </message>
    <message>
        <source>No step is entered.</source>
        <translation>Keine Stufe ist eingegeben.</translation>
    </message>
    <message>
        <source>Enter offsets from the working point, for example 0 5 −3.</source>
        <translation>Abstände vom Arbeitspunkt eingeben, zum Beispiel 0 5 −3.</translation>
    </message>
    <message>
        <source>the drag pressure</source>
        <translation>der Schleifdruck</translation>
    </message>
    <message>
        <source>the drag speed</source>
        <translation>die Schleifdrehzahl</translation>
    </message>
    <message>
        <source>the time-out</source>
        <translation>das Zeitlimit</translation>
    </message>
    <message>
        <source>the maximum temperature</source>
        <translation>die Maximaltemperatur</translation>
    </message>
    <message>
        <source>the recorded channels</source>
        <translation>die aufgezeichneten Kanäle</translation>
    </message>
    <message>
        <source>the rise time</source>
        <translation>die Anstiegszeit</translation>
    </message>
    <message>
        <source>the ventilator off</source>
        <translation>den Lüfter aus</translation>
    </message>
    <message>
        <source>temperatures</source>
        <translation>Temperaturen</translation>
    </message>
    <message>
        <source>pressures</source>
        <translation>Drücke</translation>
    </message>
    <message>
        <source>the cool-down temperature</source>
        <translation>die Abkühltemperatur</translation>
    </message>
    <message>
        <source>the sampling rate</source>
        <translation>die Abtastrate</translation>
    </message>
    <message>
        <source>the soak</source>
        <translation>die Haltezeit</translation>
    </message>
</context>
<context>
    <name>manual</name>
    <message>
        <source>The watchdog has stopped the rig.</source>
        <translation>Der Wächter hat den Prüfstand angehalten.</translation>
    </message>
    <message>
        <source>Find the cause, then reset.</source>
        <translation>Ursache finden, dann rücksetzen.</translation>
    </message>
    <message>
        <source>Stopped by the watchdog: {0}</source>
        <translation>Ausgelöst: {0}</translation>
    </message>
    <message>
        <source>Stopping</source>
        <translation>Hält an</translation>
    </message>
    <message>
        <source>Pressure is released and the disc comes to rest. Wait.</source>
        <translation>Druck wird abgelassen, die Scheibe kommt zum Stillstand. Warten.</translation>
    </message>
    <message>
        <source>nobody</source>
        <translation>niemand</translation>
    </message>
    <message>
        <source>This window watches. {0} commands.</source>
        <translation>Dieses Fenster sieht zu. {0} befiehlt.</translation>
    </message>
    <message>
        <source>Take command to move something from here; whoever had it is told.</source>
        <translation>Kommando übernehmen, um von hier etwas zu bewegen; wer es hatte, wird benachrichtigt.</translation>
    </message>
    <message>
        <source>Locked: nothing can move.</source>
        <translation>Gesperrt: nichts kann sich bewegen.</translation>
    </message>
    <message>
        <source>Press Enable. The watchdog checks the rig at rest and closes the safety relay.</source>
        <translation>Freigeben drücken. Der Wächter prüft den Prüfstand im Stillstand und schließt das Sicherheitsrelais.</translation>
    </message>
    <message>
        <source>A braking is being recorded.</source>
        <translation>Eine Bremsung wird aufgezeichnet.</translation>
    </message>
    <message>
        <source>Releasing the pressure breaks it off.</source>
        <translation>Druck ablassen bricht sie ab.</translation>
    </message>
    <message>
        <source>Enabled: motor and brake may move.</source>
        <translation>Freigegeben: Bewegung ist möglich.</translation>
    </message>
    <message>
        <source>Type a set-point and press Enter to apply it.</source>
        <translation>Sollwert tippen, Enter übernimmt.</translation>
    </message>
    <message>
        <source>Motor and brake may move. Is the door closed?</source>
        <translation>Motor und Bremse dürfen sich bewegen. Ist die Tür zu?</translation>
    </message>
    <message>
        <source>The motor may turn up to {0} and the brake apply up to {1}. Is the door closed?</source>
        <translation>Der Motor darf bis {0} drehen, die Bremse bis {1} anlegen. Ist die Tür zu?</translation>
    </message>
    <message>
        <source>There is no manual session.</source>
        <translation>Es gibt keine manuelle Sitzung.</translation>
    </message>
    <message>
        <source>No controller is left.</source>
        <translation>Keine Steuerung ist mehr da.</translation>
    </message>
    <message>
        <source>This window commands already.</source>
        <translation>Dieses Fenster befiehlt schon.</translation>
    </message>
    <message>
        <source>This window only watches. Take command first.</source>
        <translation>Dieses Fenster sieht nur zu. Zuerst Kommando übernehmen.</translation>
    </message>
    <message>
        <source>Nothing is to be reset.</source>
        <translation>Nichts ist rückzusetzen.</translation>
    </message>
    <message>
        <source>The watchdog has stopped the rig. Reset first.</source>
        <translation>Der Wächter hat den Prüfstand angehalten. Zuerst rücksetzen.</translation>
    </message>
    <message>
        <source>The rig is stopping. Wait.</source>
        <translation>Der Prüfstand hält an. Warten.</translation>
    </message>
    <message>
        <source>Motor and brake are enabled already.</source>
        <translation>Motor und Bremse sind schon freigegeben.</translation>
    </message>
    <message>
        <source>Nothing can move. Enable first.</source>
        <translation>Nichts kann sich bewegen. Zuerst freigeben.</translation>
    </message>
    <message>
        <source>A braking is being prepared.</source>
        <translation>Eine Bremsung wird vorbereitet.</translation>
    </message>
    <message>
        <source>A braking is being recorded. Wait, or release the pressure.</source>
        <translation>Eine Bremsung wird aufgezeichnet. Warten oder Druck ablassen.</translation>
    </message>
    <message>
        <source>The speed</source>
        <translation>Die Drehzahl</translation>
    </message>
    <message>
        <source>The ramp</source>
        <translation>Die Rampe</translation>
    </message>
    <message>
        <source>The pressure</source>
        <translation>Der Druck</translation>
    </message>
    <message>
        <source>The amplitude</source>
        <translation>Die Amplitude</translation>
    </message>
    <message>
        <source>The frequency</source>
        <translation>Die Frequenz</translation>
    </message>
    <message>
        <source>The duration</source>
        <translation>Die Dauer</translation>
    </message>
    <message>
        <source>The air flow</source>
        <translation>Der Luftstrom</translation>
    </message>
    <message>
        <source>The temperature</source>
        <translation>Die Temperatur</translation>
    </message>
    <message>
        <source>1/min per s</source>
        <translation>1/min je s</translation>
    </message>
    <message>
        <source>The pressure would fall to {0} bar. Raise the mean pressure or reduce the amplitude.</source>
        <translation>Der Druck würde auf {0} bar fallen. Mitteldruck erhöhen oder Amplitude verkleinern.</translation>
    </message>
</context>
<context>
    <name>model</name>
    <message>
        <source>Braking {0}: no squeal at {1}</source>
        <translation>Bremsung {0}: kein Quietschen bei {1}</translation>
    </message>
    <message>
        <source>Braking {0}: squeal at {1}, {2}, at {3}</source>
        <translation>Bremsung {0}: Quietschen bei {1}, {2}, bei {3}</translation>
    </message>
    <message>
        <source>Coefficient of friction µ</source>
        <extracomment>largest rise, as share, of which nobody speaks</extracomment>
        <translation>Reibwert µ</translation>
    </message>
    <message>
        <source>Brake pressure p</source>
        <translation>Bremsdruck p</translation>
    </message>
    <message>
        <source>Falling slope k</source>
        <translation>Fallende Steigung k</translation>
    </message>
    <message>
        <source>leading side</source>
        <translation>einlaufseitig</translation>
    </message>
    <message>
        <source>trailing side</source>
        <translation>auslaufseitig</translation>
    </message>
    <message>
        <source>{0}: factor</source>
        <translation>{0}: Faktor</translation>
    </message>
    <message>
        <source>Unstable without any pressure already</source>
        <translation>Schon ohne Druck instabil</translation>
    </message>
    <message>
        <source>Unstable without any friction already</source>
        <translation>Schon ohne Reibung instabil</translation>
    </message>
    <message>
        <source>No squeal up to {0}</source>
        <translation>Kein Quietschen bis {0}</translation>
    </message>
    <message>
        <source>Diverges without vibration from {0}</source>
        <translation>Divergiert ohne Schwingung ab {0}</translation>
    </message>
    <message>
        <source>Squeals from {0} at {1}</source>
        <translation>Quietscht ab {0} mit {1}</translation>
    </message>
    <message>
        <source>{0}, at any pressure</source>
        <translation>{0}, bei jedem Druck</translation>
    </message>
    <message>
        <source>1 mode unstable</source>
        <translation>1 Mode instabil</translation>
    </message>
    <message>
        <source>{0} modes unstable</source>
        <translation>{0} Moden instabil</translation>
    </message>
    <message>
        <source>Now ({0}): {1}, {2} grows with {3}</source>
        <translation>Jetzt ({0}): {1}, {2} wächst mit {3}</translation>
    </message>
    <message>
        <source>Now ({0}): stable, least damping {1} at {2}</source>
        <translation>Jetzt ({0}): stabil, kleinster Dämpfungsgrad {1} bei {2}</translation>
    </message>
    <message>
        <source>Mode {0} · {1} · {2} · damping {3} · {4}</source>
        <translation>Mode {0} · {1} · {2} · D {3} · {4}</translation>
    </message>
    <message>
        <source>unstable</source>
        <translation>instabil</translation>
    </message>
    <message>
        <source>stable</source>
        <translation>stabil</translation>
    </message>
    <message>
        <source>recommended</source>
        <translation>empfohlen</translation>
    </message>
    <message>
        <source>with care</source>
        <translation>mit Vorsicht</translation>
    </message>
    <message>
        <source>no effect</source>
        <translation>ohne Wirkung</translation>
    </message>
    <message>
        <source>not recommended</source>
        <translation>nicht empfohlen</translation>
    </message>
    <message>
        <source>lowers the real parts below {0} kHz by {1} 1/s in all at every friction from {2} to {3}</source>
        <translation>senkt die Realteile unter {0} kHz um insgesamt {1} 1/s bei jedem Reibwert von {2} bis {3}</translation>
    </message>
    <message>
        <source>raises the real parts below {0} kHz by up to {1} 1/s in all</source>
        <translation>hebt die Realteile unter {0} kHz um insgesamt bis zu {1} 1/s</translation>
    </message>
    <message>
        <source>hardly changes the real parts below {0} kHz</source>
        <translation>ändert die Realteile unter {0} kHz kaum</translation>
    </message>
    <message>
        <source>makes no mode worse</source>
        <translation>verschlechtert keine Mode</translation>
    </message>
    <message>
        <source>raises that of the mode at {0} Hz by {1} %</source>
        <translation>hebt den der Mode bei {0} Hz um {1} %</translation>
    </message>
    <message>
        <source>leaves the onset at {0} bar</source>
        <translation>lässt das Einsetzen bei {0} bar</translation>
    </message>
    <message>
        <source>moves the onset from {0} to {1} bar</source>
        <translation>verschiebt das Einsetzen von {0} auf {1} bar</translation>
    </message>
    <message>
        <source>stays stable over the whole range of pressure</source>
        <translation>bleibt über den ganzen Druckbereich stabil</translation>
    </message>
    <message>
        <source>Gain: the sum of real parts below {0} kHz falls at every friction from {1} to {2} by more than {3} % of their mean. Harm: a real part rises by more than {4} % of itself. Onset: moves by more than {5} %.</source>
        <translation>Gewinn: die Summe der Realteile unter {0} kHz fällt bei jedem Reibwert von {1} bis {2} um mehr als {3} % ihres Mittels. Schaden: ein Realteil steigt um mehr als {4} % seiner selbst. Einsetzen: verschiebt sich um mehr als {5} %.</translation>
    </message>
</context>
<context>
    <name>pages</name>
    <message>
        <source>Manual</source>
        <translation>Manuell</translation>
    </message>
    <message>
        <source>Sequence</source>
        <translation>Sequenz</translation>
    </message>
    <message>
        <source>Run</source>
        <translation>Lauf</translation>
    </message>
    <message>
        <source>Data</source>
        <translation>Daten</translation>
    </message>
    <message>
        <source>Model</source>
        <translation>Modell</translation>
    </message>
    <message>
        <source>Service</source>
        <translation>Service</translation>
    </message>
</context>
<context>
    <name>pictures</name>
    <message>
        <source>Save picture</source>
        <translation>Bild speichern</translation>
    </message>
    <message>
        <source>Picture (*.png)</source>
        <translation>Bild (*.png)</translation>
    </message>
    <message>
        <source>Drawing (*.svg)</source>
        <translation>Zeichnung (*.svg)</translation>
    </message>
    <message>
        <source>Picture not saved: {0}</source>
        <translation>Bild nicht gespeichert: {0}</translation>
    </message>
    <message>
        <source>Picture saved as {0}</source>
        <translation>Bild gespeichert als {0}</translation>
    </message>
</context>
<context>
    <name>plots</name>
    <message>
        <source>Saved as {0}</source>
        <translation>Gespeichert als {0}</translation>
    </message>
    <message>
        <source>{0} cannot be written; choose another folder</source>
        <translation>{0} ist nicht beschreibbar; anderen Ordner wählen</translation>
    </message>
</context>
<context>
    <name>rig</name>
    <message>
        <source>arming</source>
        <translation>schaltet scharf</translation>
    </message>
    <message>
        <source>paused</source>
        <translation>Pause</translation>
    </message>
    <message>
        <source>ready</source>
        <translation>bereit</translation>
    </message>
    <message>
        <source>locked</source>
        <translation>gesperrt</translation>
    </message>
    <message>
        <source>by hand</source>
        <translation>von Hand</translation>
    </message>
    <message>
        <source>safe state</source>
        <translation>sicherer Zustand</translation>
    </message>
    <message>
        <source>conditioning</source>
        <translation>Konditionierung</translation>
    </message>
    <message>
        <source>pressure course</source>
        <translation>Druckverlauf</translation>
    </message>
    <message>
        <source>braking</source>
        <translation>bremst</translation>
    </message>
    <message>
        <source>releasing</source>
        <translation>löst</translation>
    </message>
    <message>
        <source>dwelling</source>
        <translation>Pause zwischen Bremsungen</translation>
    </message>
    <message>
        <source>stopping</source>
        <translation>hält an</translation>
    </message>
    <message>
        <source>spinning up to {0} 1/min</source>
        <translation>fährt hoch auf {0} 1/min</translation>
    </message>
    <message>
        <source>braking with {0} bar</source>
        <translation>bremst mit {0} bar</translation>
    </message>
    <message>
        <source>heating to {0} °C</source>
        <translation>heizt auf {0} °C</translation>
    </message>
    <message>
        <source>cooling to {0} °C</source>
        <translation>kühlt auf {0} °C</translation>
    </message>
    <message>
        <source>resting until {0} °C</source>
        <translation>ruht bis {0} °C</translation>
    </message>
    <message>
        <source>soaking at {0} °C</source>
        <translation>hält {0} °C</translation>
    </message>
    <message>
        <source>finished</source>
        <translation>fertig</translation>
    </message>
    <message>
        <source>stopped</source>
        <translation>angehalten</translation>
    </message>
    <message>
        <source>tripped</source>
        <translation>ausgelöst</translation>
    </message>
    <message>
        <source>failed</source>
        <translation>fehlgeschlagen</translation>
    </message>
    <message>
        <source>{0}: {1} of {2} brakings complete</source>
        <translation>{0}: {1} von {2} Bremsungen vollständig</translation>
    </message>
    <message>
        <source>The controller process has gone.</source>
        <translation>Der Prozess der Steuerung ist weg.</translation>
    </message>
    <message>
        <source>The watchdog brings the rig to the safe state.</source>
        <translation>Der Wächter bringt den Prüfstand in den sicheren Zustand.</translation>
    </message>
    <message>
        <source>The rig is in the safe state: torque off, pressure vented.</source>
        <translation>Der Prüfstand ist im sicheren Zustand: Moment weg, Druck abgelassen.</translation>
    </message>
    <message>
        <source>The controller has gone; waiting for the safe state …</source>
        <translation>Die Steuerung ist weg; warten auf den sicheren Zustand …</translation>
    </message>
    <message>
        <source>stop by the operator</source>
        <translation>Stopp von Hand</translation>
    </message>
    <message>
        <source>stopped by the operator</source>
        <translation>von Hand angehalten</translation>
    </message>
    <message>
        <source>pause by the operator</source>
        <translation>Pause von Hand</translation>
    </message>
    <message>
        <source>skip by the operator</source>
        <translation>von Hand übersprungen</translation>
    </message>
    <message>
        <source>repeat by the operator</source>
        <translation>von Hand wiederholt</translation>
    </message>
    <message>
        <source>pressure by hand</source>
        <translation>Druck von Hand</translation>
    </message>
    <message>
        <source>speed by hand</source>
        <translation>Drehzahl von Hand</translation>
    </message>
    <message>
        <source>conditioning by hand</source>
        <translation>Konditionierung von Hand</translation>
    </message>
    <message>
        <source>disabled by the operator</source>
        <translation>von Hand gesperrt</translation>
    </message>
    <message>
        <source>enabled again</source>
        <translation>wieder freigegeben</translation>
    </message>
    <message>
        <source>nobody commands</source>
        <translation>niemand befiehlt</translation>
    </message>
    <message>
        <source>safety trip: {0}</source>
        <translation>Auslösung: {0}</translation>
    </message>
    <message>
        <source>disc at {0} °C, above max_degc {1} °C</source>
        <translation>Scheibe bei {0} °C, über der Maximaltemperatur {1} °C</translation>
    </message>
    <message>
        <source>conditioning: {0}</source>
        <translation>Konditionierung: {0}</translation>
    </message>
    <message>
        <source>spin up: {0}</source>
        <translation>Hochfahren: {0}</translation>
    </message>
    <message>
        <source>release: {0}</source>
        <translation>Lösen: {0}</translation>
    </message>
    <message>
        <source>run down: {0}</source>
        <translation>Herunterfahren: {0}</translation>
    </message>
    <message>
        <source>the disc has {0} °C, not {1} °C, after {2} s.</source>
        <translation>die Scheibe hat nach {2} s {0} °C, nicht {1} °C.</translation>
    </message>
    <message>
        <source>the drive did not reach {0} 1/min within {1} s.</source>
        <translation>der Antrieb erreichte {0} 1/min nicht in {1} s.</translation>
    </message>
    <message>
        <source>{0} bar remain {1} s after the release.</source>
        <translation>{1} s nach dem Lösen bleiben {0} bar.</translation>
    </message>
    <message>
        <source>the rig does not come to rest: {0} 1/min, {1} bar.</source>
        <translation>der Prüfstand kommt nicht zum Stillstand: {0} 1/min, {1} bar.</translation>
    </message>
    <message>
        <source>Look at the drive&apos;s ramp settings and its current limit.</source>
        <translation>Rampe und Stromgrenze des Antriebs ansehen.</translation>
    </message>
    <message>
        <source>Check the vent valve.</source>
        <translation>Entlüftungsventil prüfen.</translation>
    </message>
    <message>
        <source>Use the emergency stop.</source>
        <translation>Not-Halt drücken.</translation>
    </message>
    <message>
        <source>Remove the cause, then run `rigctl resume`.</source>
        <translation>Ursache beseitigen, dann fortsetzen (rigctl resume).</translation>
    </message>
    <message>
        <source>torque</source>
        <translation>Moment</translation>
    </message>
    <message>
        <source>microphone</source>
        <translation>Mikrofon</translation>
    </message>
    <message>
        <source>emissivity</source>
        <translation>Emissionsgrad</translation>
    </message>
    <message>
        <source>brake pressure has no valid reading</source>
        <translation>der Bremsdruck hat keinen gültigen Wert</translation>
    </message>
    <message>
        <source>speed has no valid reading</source>
        <translation>die Drehzahl hat keinen gültigen Wert</translation>
    </message>
    <message>
        <source>torque has no valid reading</source>
        <translation>das Moment hat keinen gültigen Wert</translation>
    </message>
    <message>
        <source>disc temperature has no valid reading</source>
        <translation>die Scheibentemperatur hat keinen gültigen Wert</translation>
    </message>
    <message>
        <source>brake pressure is not measured any more</source>
        <translation>der Bremsdruck wird nicht mehr gemessen</translation>
    </message>
    <message>
        <source>speed is not measured any more</source>
        <translation>die Drehzahl wird nicht mehr gemessen</translation>
    </message>
    <message>
        <source>torque is not measured any more</source>
        <translation>das Moment wird nicht mehr gemessen</translation>
    </message>
    <message>
        <source>disc temperature is not measured any more</source>
        <translation>die Scheibentemperatur wird nicht mehr gemessen</translation>
    </message>
    <message>
        <source>brake pressure has been the same number for too long</source>
        <translation>der Bremsdruck ist zu lange dieselbe Zahl</translation>
    </message>
    <message>
        <source>speed has been the same number for too long</source>
        <translation>die Drehzahl ist zu lange dieselbe Zahl</translation>
    </message>
    <message>
        <source>torque has been the same number for too long</source>
        <translation>das Moment ist zu lange dieselbe Zahl</translation>
    </message>
    <message>
        <source>disc temperature has been the same number for too long</source>
        <translation>die Scheibentemperatur ist zu lange dieselbe Zahl</translation>
    </message>
    <message>
        <source>blocks of the safety channel are missing or repeated</source>
        <translation>Blöcke des Sicherheitskanals fehlen oder wiederholen sich</translation>
    </message>
    <message>
        <source>the safety channel&apos;s clock does not fit its blocks</source>
        <translation>die Uhr des Sicherheitskanals passt nicht zu seinen Blöcken</translation>
    </message>
    <message>
        <source>brake pressure in bar is far too high</source>
        <translation>der Bremsdruck in bar ist viel zu hoch</translation>
    </message>
    <message>
        <source>brake pressure in bar is out of its range</source>
        <translation>der Bremsdruck in bar ist außerhalb seines Bereichs</translation>
    </message>
    <message>
        <source>speed in 1/min is out of its range</source>
        <translation>die Drehzahl in 1/min ist außerhalb ihres Bereichs</translation>
    </message>
    <message>
        <source>torque in N·m is out of its range</source>
        <translation>das Moment in N·m ist außerhalb seines Bereichs</translation>
    </message>
    <message>
        <source>disc temperature in °C is out of its range</source>
        <translation>die Scheibentemperatur in °C ist außerhalb ihres Bereichs</translation>
    </message>
    <message>
        <source>disc temperature in °C would pass its limit before a stop</source>
        <translation>die Scheibentemperatur in °C würde vor dem Halt ihren Grenzwert überschreiten</translation>
    </message>
    <message>
        <source>friction power in kW is far too high</source>
        <translation>die Reibleistung in kW ist viel zu hoch</translation>
    </message>
    <message>
        <source>friction power in kW is too high</source>
        <translation>die Reibleistung in kW ist zu hoch</translation>
    </message>
    <message>
        <source>the safety relay reads closed though it was told to open</source>
        <translation>das Sicherheitsrelais meldet geschlossen, obwohl es öffnen soll</translation>
    </message>
    <message>
        <source>the safety relay reads open though it was told to close</source>
        <translation>das Sicherheitsrelais meldet offen, obwohl es schließen soll</translation>
    </message>
    <message>
        <source>the drive says it is enabled while the safety relay is open</source>
        <translation>der Antrieb meldet freigegeben, während das Sicherheitsrelais offen ist</translation>
    </message>
    <message>
        <source>the safety channel is at fault</source>
        <translation>der Sicherheitskanal ist gestört</translation>
    </message>
    <message>
        <source>the emergency stop is pressed</source>
        <translation>der Not-Halt ist gedrückt</translation>
    </message>
    <message>
        <source>a door is open</source>
        <translation>eine Tür ist offen</translation>
    </message>
    <message>
        <source>the controller&apos;s heartbeat is wrong</source>
        <translation>das Lebenszeichen der Steuerung ist falsch</translation>
    </message>
    <message>
        <source>the controller&apos;s heartbeat does not come</source>
        <translation>das Lebenszeichen der Steuerung bleibt aus</translation>
    </message>
    <message>
        <source>the controller commands a set-point that is not allowed</source>
        <translation>die Steuerung befiehlt einen unerlaubten Sollwert</translation>
    </message>
    <message>
        <source>the controller has gone</source>
        <translation>die Steuerung ist weg</translation>
    </message>
    <message>
        <source>the controller does not read the watchdog&apos;s status</source>
        <translation>die Steuerung liest den Status des Wächters nicht</translation>
    </message>
    <message>
        <source>the safety channel is silent</source>
        <translation>der Sicherheitskanal schweigt</translation>
    </message>
    <message>
        <source>the link to the rig&apos;s safety channel is closed</source>
        <translation>die Verbindung zum Sicherheitskanal des Prüfstands ist zu</translation>
    </message>
    <message>
        <source>the safety channel sends what cannot be read</source>
        <translation>der Sicherheitskanal sendet Unlesbares</translation>
    </message>
    <message>
        <source>the limits in memory have changed</source>
        <translation>die Grenzwerte im Speicher haben sich geändert</translation>
    </message>
    <message>
        <source>a cycle of the watchdog was not complete</source>
        <translation>ein Zyklus des Wächters war unvollständig</translation>
    </message>
    <message>
        <source>the watchdog has failed</source>
        <translation>der Wächter ist ausgefallen</translation>
    </message>
    <message>
        <source>the journal cannot be written</source>
        <translation>das Journal ist nicht beschreibbar</translation>
    </message>
    <message>
        <source>the watchdog was told to end while the rig was armed</source>
        <translation>der Wächter sollte enden, während der Prüfstand scharf war</translation>
    </message>
    <message>
        <source>Look at the sensor, its cable and its supply; then reset with a reason.</source>
        <translation>Sensor, Kabel und Versorgung ansehen; dann mit Grund rücksetzen.</translation>
    </message>
    <message>
        <source>Look at the controller&apos;s log; reset with a reason or resume the campaign.</source>
        <translation>Protokoll der Steuerung ansehen; mit Grund rücksetzen oder die Kampagne fortsetzen.</translation>
    </message>
    <message>
        <source>Find out why before anything moves again; then reset with a reason.</source>
        <translation>Ursache finden, bevor sich wieder etwas bewegt; dann mit Grund rücksetzen.</translation>
    </message>
    <message>
        <source>Start the watchdog anew.</source>
        <translation>Den Wächter neu starten.</translation>
    </message>
    <message>
        <source>Let the disc cool; then reset.</source>
        <translation>Scheibe abkühlen lassen; dann rücksetzen.</translation>
    </message>
    <message>
        <source>Switch the drive off at its main switch. The relay or its read-back is defective.</source>
        <translation>Antrieb am Hauptschalter ausschalten. Das Relais oder seine Rückmeldung ist defekt.</translation>
    </message>
    <message>
        <source>Look at emergency stop, doors, the relay and its read-back; then reset.</source>
        <translation>Not-Halt, Türen, Relais und seine Rückmeldung ansehen; dann rücksetzen.</translation>
    </message>
    <message>
        <source>Switch the drive off at its main switch. Its torque-off input does not work.</source>
        <translation>Antrieb am Hauptschalter ausschalten. Sein Moment-aus-Eingang wirkt nicht.</translation>
    </message>
    <message>
        <source>Release it at the rig; then reset.</source>
        <translation>Am Prüfstand entriegeln; dann rücksetzen.</translation>
    </message>
    <message>
        <source>Close it; then reset.</source>
        <translation>Schließen; dann rücksetzen.</translation>
    </message>
    <message>
        <source>Make room on the disk; start the watchdog anew.</source>
        <translation>Platz auf der Platte schaffen; den Wächter neu starten.</translation>
    </message>
    <message>
        <source>An earlier trip has not been acknowledged: {0}</source>
        <translation>Eine frühere Auslösung ist nicht quittiert: {0}</translation>
    </message>
    <message>
        <source>Acknowledge it with your name and a reason.</source>
        <translation>Mit Name und Grund quittieren.</translation>
    </message>
    <message>
        <source>Seen so far: {0} good samples of {1}, {2} good heartbeats of {3}.</source>
        <translation>Bisher gesehen: {0} von {1} guten Werten, {2} von {3} guten Lebenszeichen.</translation>
    </message>
    <message>
        <source>The rig is not at rest: {0}.</source>
        <translation>Der Prüfstand steht nicht still: {0}.</translation>
    </message>
    <message>
        <source>The controller&apos;s set-points are not zero.</source>
        <translation>Die Sollwerte der Steuerung sind nicht null.</translation>
    </message>
    <message>
        <source>Arm with pressure and speed at zero.</source>
        <translation>Mit Druck und Drehzahl null scharf schalten.</translation>
    </message>
    <message>
        <source>The limits file has been changed since the watchdog read it.</source>
        <translation>Die Grenzwertdatei wurde geändert, seit der Wächter sie las.</translation>
    </message>
    <message>
        <source>Start the watchdog anew, so that it reads the new file.</source>
        <translation>Den Wächter neu starten, damit er die neue Datei liest.</translation>
    </message>
    <message>
        <source>The proof test failed for {0}.</source>
        <translation>Der Selbsttest schlug fehl für {0}.</translation>
    </message>
    <message>
        <source>Look at the limits of these checks.</source>
        <translation>Grenzwerte dieser Prüfungen ansehen.</translation>
    </message>
    <message>
        <source>The reset does not say {0}.</source>
        <translation>Dem Rücksetzen fehlt: {0}.</translation>
    </message>
    <message>
        <source>Give your name and a reason in words.</source>
        <translation>Name und Grund in Worten angeben.</translation>
    </message>
    <message>
        <source>This trip cannot be reset: {0}</source>
        <translation>Diese Auslösung lässt sich nicht rücksetzen: {0}</translation>
    </message>
    <message>
        <source>The same cause has been reset {0} times within an hour.</source>
        <translation>Dieselbe Ursache wurde in einer Stunde {0}-mal rückgesetzt.</translation>
    </message>
    <message>
        <source>The same cause has been reset too often this hour.</source>
        <translation>Dieselbe Ursache wurde in dieser Stunde zu oft rückgesetzt.</translation>
    </message>
    <message>
        <source>Find the cause; a further reset is possible an hour after the first.</source>
        <translation>Ursache finden; rücksetzen geht erst eine Stunde nach dem ersten Mal wieder.</translation>
    </message>
    <message>
        <source>The safety relay still reads closed.</source>
        <translation>Das Sicherheitsrelais meldet noch geschlossen.</translation>
    </message>
    <message>
        <source>Look at the relay.</source>
        <translation>Das Relais ansehen.</translation>
    </message>
    <message>
        <source>The rig has not been at rest for {0} s: {1}.</source>
        <translation>Der Prüfstand steht noch keine {0} s still: {1}.</translation>
    </message>
    <message>
        <source>The controller has given {0} good heartbeats of {1}.</source>
        <translation>Die Steuerung gab {0} von {1} guten Lebenszeichen.</translation>
    </message>
    <message>
        <source>Wait, or look at the controller.</source>
        <translation>Warten, oder die Steuerung ansehen.</translation>
    </message>
    <message>
        <source>Make room on the disk.</source>
        <translation>Platz auf der Platte schaffen.</translation>
    </message>
    <message>
        <source>Wait.</source>
        <translation>Warten.</translation>
    </message>
    <message>
        <source>the safety relay has opened.</source>
        <translation>das Sicherheitsrelais hat geöffnet.</translation>
    </message>
    <message>
        <source>Look at emergency stop, doors and logs/watchdog.log.</source>
        <translation>Not-Halt, Türen und logs/watchdog.log ansehen.</translation>
    </message>
    <message>
        <source>the watchdog does not arm.</source>
        <translation>der Wächter schaltet nicht scharf.</translation>
    </message>
    <message>
        <source>the watchdog does not arm. {0}</source>
        <translation>der Wächter schaltet nicht scharf. {0}</translation>
    </message>
    <message>
        <source>See the journal and logs/watchdog.log.</source>
        <translation>Journal und logs/watchdog.log ansehen.</translation>
    </message>
    <message>
        <source>the watchdog has been silent for {0} s; the safety relay opens by itself.</source>
        <translation>der Wächter schweigt seit {0} s; das Sicherheitsrelais öffnet von selbst.</translation>
    </message>
    <message>
        <source>See logs/watchdog.log and the load of the machine, then run `rigctl resume`.</source>
        <translation>logs/watchdog.log und Last des Rechners ansehen, dann fortsetzen (rigctl resume).</translation>
    </message>
    <message>
        <source>the watchdog process has gone; the safety relay has opened.</source>
        <translation>der Prozess des Wächters ist weg; das Sicherheitsrelais hat geöffnet.</translation>
    </message>
    <message>
        <source>Nothing moves without it. See logs/watchdog.log, then run `rigctl resume`.</source>
        <translation>Ohne ihn bewegt sich nichts. logs/watchdog.log ansehen, dann fortsetzen (rigctl resume).</translation>
    </message>
    <message>
        <source>a program is running.</source>
        <translation>ein Programm läuft.</translation>
    </message>
    <message>
        <source>Set-points by hand belong to a manual session.</source>
        <translation>Sollwerte von Hand gehören in eine manuelle Sitzung.</translation>
    </message>
    <message>
        <source>nothing has tripped.</source>
        <translation>nichts hat ausgelöst.</translation>
    </message>
    <message>
        <source>asked for again.</source>
        <translation>nochmals verlangt.</translation>
    </message>
    <message>
        <source>the watchdog has tripped.</source>
        <translation>der Wächter hat ausgelöst.</translation>
    </message>
    <message>
        <source>Remove the cause, then reset.</source>
        <translation>Ursache beseitigen, dann rücksetzen.</translation>
    </message>
    <message>
        <source>a braking is being recorded.</source>
        <translation>eine Bremsung wird aufgezeichnet.</translation>
    </message>
    <message>
        <source>Release or stop it first.</source>
        <translation>Zuerst Druck ablassen oder anhalten.</translation>
    </message>
    <message>
        <source>the rig is locked.</source>
        <translation>der Prüfstand ist gesperrt.</translation>
    </message>
    <message>
        <source>Enable it first.</source>
        <translation>Zuerst freigeben.</translation>
    </message>
    <message>
        <source>the rig is running down.</source>
        <translation>der Prüfstand fährt herunter.</translation>
    </message>
    <message>
        <source>Wait until it rests.</source>
        <translation>Warten, bis er stillsteht.</translation>
    </message>
    <message>
        <source>temperature {0} °C is outside {1} … {2} °C.</source>
        <translation>Temperatur {0} °C liegt außerhalb {1} … {2} °C.</translation>
    </message>
    <message>
        <source>speed {0} 1/min is outside {1} … {2} 1/min.</source>
        <translation>Drehzahl {0} 1/min liegt außerhalb {1} … {2} 1/min.</translation>
    </message>
    <message>
        <source>ramp {0} 1/min/s is above {1} 1/min/s.</source>
        <translation>Rampe {0} 1/min/s liegt über {1} 1/min/s.</translation>
    </message>
    <message>
        <source>the pressure would fall to {0} bar.</source>
        <translation>der Druck würde auf {0} bar fallen.</translation>
    </message>
    <message>
        <source>Lower the amplitude.</source>
        <translation>Amplitude verkleinern.</translation>
    </message>
    <message>
        <source>the pressure would rise to {0} bar, above {1} bar.</source>
        <translation>der Druck würde auf {0} bar steigen, über {1} bar.</translation>
    </message>
    <message>
        <source>the actuator cannot hold less than {0} bar.</source>
        <translation>der Aktor kann nicht weniger als {0} bar halten.</translation>
    </message>
    <message>
        <source>Give 0 to release.</source>
        <translation>0 angeben zum Lösen.</translation>
    </message>
    <message>
        <source>a pressure function without a duration.</source>
        <translation>ein Druckverlauf ohne Dauer.</translation>
    </message>
    <message>
        <source>Give the duration in seconds.</source>
        <translation>Dauer in Sekunden angeben.</translation>
    </message>
    <message>
        <source>{0}: {1} (limit {2}).</source>
        <translation>{0}: {1} (Grenzwert {2}).</translation>
    </message>
    <message>
        <source>{0}: {1}.</source>
        <translation>{0}: {1}.</translation>
    </message>
</context>
<context>
    <name>run</name>
    <message>
        <source>Breaks off this braking now, releases, stops the disc and waits. Resume does it again.</source>
        <translation>Bricht diese Bremsung jetzt ab, löst, hält die Scheibe an und wartet. Fortsetzen macht sie neu.</translation>
    </message>
    <message>
        <source>Finishes this braking, then releases, stops the disc and waits.</source>
        <translation>Macht diese Bremsung zu Ende, löst dann, hält die Scheibe an und wartet.</translation>
    </message>
    <message>
        <source>Goes on; after Hold it takes the wish to wait back.</source>
        <translation>Macht weiter; nach „Danach halten“ nimmt es den Wunsch zu warten zurück.</translation>
    </message>
    <message>
        <source>Breaks off this braking and goes on with the next. It counts as not complete.</source>
        <translation>Bricht diese Bremsung ab und macht mit der nächsten weiter. Sie zählt als nicht vollständig.</translation>
    </message>
    <message>
        <source>Breaks off this braking and starts it again. What was recorded is kept aside.</source>
        <translation>Bricht diese Bremsung ab und beginnt sie neu. Was aufgezeichnet wurde, wird beiseitegelegt.</translation>
    </message>
    <message>
        <source>Breaks off this braking, releases, stops the disc and ends the run. It can be resumed later.</source>
        <translation>Bricht diese Bremsung ab, löst, hält die Scheibe an und beendet den Lauf. Er lässt sich später fortsetzen.</translation>
    </message>
    <message>
        <source>No program is running.</source>
        <translation>Kein Programm läuft.</translation>
    </message>
    <message>
        <source>This window only watches. Take command first.</source>
        <translation>Dieses Fenster sieht nur zu. Zuerst Kommando übernehmen.</translation>
    </message>
    <message>
        <source>The run waits already.</source>
        <translation>Der Lauf wartet schon.</translation>
    </message>
    <message>
        <source>It will wait after this braking already.</source>
        <translation>Er wird schon nach dieser Bremsung warten.</translation>
    </message>
    <message>
        <source>The run does not wait.</source>
        <translation>Der Lauf wartet nicht.</translation>
    </message>
</context>
<context>
    <name>sequence</name>
    <message>
        <source>The first entries of the lists are run together, then the second ones, …</source>
        <translation>Die ersten Einträge der Listen laufen zusammen, dann die zweiten, …</translation>
    </message>
    <message>
        <source>Outermost first: {0} changes most rarely, {1} with every braking.</source>
        <translation>Äußerste zuerst: {0} wechselt am seltensten, {1} bei jeder Bremsung.</translation>
    </message>
    <message>
        <source>Cannot be started: add a sequence first.</source>
        <translation>Kein Start: zuerst eine Sequenz hinzufügen.</translation>
    </message>
    <message>
        <source>Cannot be started: no rig file is found.</source>
        <translation>Kein Start: keine Prüfstandsdatei gefunden.</translation>
    </message>
    <message>
        <source>Checking every set-point against the rig …</source>
        <translation>Alle Sollwerte werden gegen den Prüfstand geprüft …</translation>
    </message>
    <message>
        <source>A session is being started.</source>
        <translation>Eine Sitzung startet.</translation>
    </message>
    <message>
        <source>A program is running; see the run page.</source>
        <translation>Ein Programm läuft; siehe Seite Lauf.</translation>
    </message>
    <message>
        <source>A manual session is open; end it on the manual page first.</source>
        <translation>Eine manuelle Sitzung ist offen; sie zuerst auf der Seite Manuell beenden.</translation>
    </message>
    <message>
        <source>Cannot be started: {0}</source>
        <translation>Kein Start: {0}</translation>
    </message>
    <message>
        <source>Cannot be started, {0} errors. First: {1}</source>
        <translation>Kein Start, {0} Fehler. Erster: {1}</translation>
    </message>
    <message>
        <source>{0} on {1}</source>
        <translation>{0} auf {1}</translation>
    </message>
    <message>
        <source>{0}, about {1} of rig time</source>
        <translation>{0}, etwa {1} Prüfstandszeit</translation>
    </message>
    <message>
        <source>up to {0} of data</source>
        <translation>bis zu {0} Daten</translation>
    </message>
    <message>
        <source>, {0} of disk left</source>
        <translation>, {0} auf der Platte frei</translation>
    </message>
    <message>
        <source>: that may not fit</source>
        <translation>: das passt vielleicht nicht</translation>
    </message>
    <message>
        <source>▲ The REAL rig will move, heat and brake.</source>
        <translation>▲ Der ECHTE Prüfstand wird sich bewegen, heizen und bremsen.</translation>
    </message>
    <message>
        <source>▲ Warnings: {0}, see above</source>
        <translation>▲ Warnungen: {0}, siehe oben</translation>
    </message>
    <message>
        <source>Not saved: a copy is kept and run.</source>
        <translation>Nicht gespeichert: eine Kopie wird abgelegt und läuft.</translation>
    </message>
    <message>
        <source>bedding</source>
        <translation>Einbremsen</translation>
    </message>
    <message>
        <source>matrix</source>
        <translation>Matrix</translation>
    </message>
    <message>
        <source>friction</source>
        <translation>Reibwert</translation>
    </message>
    <message>
        <source>stop</source>
        <translation>Stopp</translation>
    </message>
    <message>
        <source>calibration</source>
        <translation>Kalibrierung</translation>
    </message>
    <message>
        <source>check</source>
        <translation>Kontrolle</translation>
    </message>
    <message>
        <source>constant</source>
        <translation>konstant</translation>
    </message>
    <message>
        <source>ramp</source>
        <translation>Rampe</translation>
    </message>
    <message>
        <source>sine</source>
        <translation>Sinus</translation>
    </message>
    <message>
        <source>triangle</source>
        <translation>Dreieck</translation>
    </message>
    <message>
        <source>steps</source>
        <translation>Stufen</translation>
    </message>
    <message>
        <source>Temperature</source>
        <translation>Temperatur</translation>
    </message>
    <message>
        <source>Speed</source>
        <translation>Drehzahl</translation>
    </message>
    <message>
        <source>Pressure</source>
        <translation>Druck</translation>
    </message>
    <message>
        <source>pressure</source>
        <translation>Druck</translation>
    </message>
    <message>
        <source>speed</source>
        <translation>Drehzahl</translation>
    </message>
    <message>
        <source>sound (microphone)</source>
        <translation>Schall (Mikrofon)</translation>
    </message>
    <message>
        <source>torque</source>
        <translation>Moment</translation>
    </message>
    <message>
        <source>disc temperature</source>
        <translation>Scheibentemperatur</translation>
    </message>
    <message>
        <source>name</source>
        <translation>Name</translation>
    </message>
    <message>
        <source>repeat</source>
        <translation>Wiederholungen</translation>
    </message>
    <message>
        <source>temperatures</source>
        <translation>Temperaturen</translation>
    </message>
    <message>
        <source>speed profiles</source>
        <translation>Drehzahlverläufe</translation>
    </message>
    <message>
        <source>pressures</source>
        <translation>Drücke</translation>
    </message>
    <message>
        <source>combinations</source>
        <translation>Abarbeitung</translation>
    </message>
    <message>
        <source>pressure course</source>
        <translation>Druckverlauf</translation>
    </message>
    <message>
        <source>amplitude</source>
        <translation>Amplitude</translation>
    </message>
    <message>
        <source>frequency</source>
        <translation>Frequenz</translation>
    </message>
    <message>
        <source>rise time</source>
        <translation>Anstiegszeit</translation>
    </message>
    <message>
        <source>tolerance</source>
        <translation>Toleranz</translation>
    </message>
    <message>
        <source>soak</source>
        <translation>Haltezeit</translation>
    </message>
    <message>
        <source>time-out</source>
        <translation>Zeitlimit</translation>
    </message>
    <message>
        <source>drag speed</source>
        <translation>Schleifdrehzahl</translation>
    </message>
    <message>
        <source>drag pressure</source>
        <translation>Schleifdruck</translation>
    </message>
    <message>
        <source>maximum temperature</source>
        <translation>Maximaltemperatur</translation>
    </message>
    <message>
        <source>cool-down temperature</source>
        <translation>Abkühltemperatur</translation>
    </message>
    <message>
        <source>sampling rate</source>
        <translation>Abtastrate</translation>
    </message>
    <message>
        <source>channels</source>
        <translation>Kanäle</translation>
    </message>
    <message>
        <source>recording before the pressure</source>
        <translation>Aufzeichnung vor dem Druck</translation>
    </message>
    <message>
        <source>recording after the release</source>
        <translation>Aufzeichnung nach dem Lösen</translation>
    </message>
    <message>
        <source>rest</source>
        <translation>Pause</translation>
    </message>
    <message>
        <source>ventilator</source>
        <translation>Lüfter</translation>
    </message>
    <message>
        <source>1 braking</source>
        <translation>1 Bremsung</translation>
    </message>
    <message>
        <source>{0} brakings</source>
        <translation>{0} Bremsungen</translation>
    </message>
</context>
</TS>
