<?xml version="1.0" encoding="utf-8"?>
<!DOCTYPE TS>
<TS version="2.1" language="de" sourcelanguage="en">
  <context>
    <name>App::Property</name>
    <message>
      <source>Bound on circumradius / shortest edge of a tetrahedron that is not thin</source>
      <translation>Schranke für Umkugelradius / kürzeste Kante eines Tetraeders, das nicht dünn ist</translation>
    </message>
    <message>
      <source>Bound on dihedral angles in collars, the tetrahedra that touch a crease</source>
      <translation>Schranke für Diederwinkel in Kragen, den Tetraedern, die einen Falz berühren</translation>
    </message>
    <message>
      <source>Boundary layers along faces</source>
      <translation>Randschichten an Flächen</translation>
    </message>
    <message>
      <source>Dimension of the elements. 3D: tetrahedra in solids; 2D: triangles on faces, for shells; 1D: lines on edges, for beams; From Shape: by what the shape encloses</source>
      <translation>Dimension der Elemente. 3D: Tetraeder in Volumenkörpern; 2D: Dreiecke auf Flächen, für Schalen; 1D: Linien auf Kanten, für Balken; From Shape: danach, was die Form umschließt</translation>
    </message>
    <message>
      <source>Divide the prisms and pyramids of layers into tetrahedra</source>
      <translation>Die Prismen und Pyramiden von Schichten in Tetraeder teilen</translation>
    </message>
    <message>
      <source>Faces and edges near which the size holds</source>
      <translation>Flächen und Kanten, in deren Nähe die Größe gilt</translation>
    </message>
    <message>
      <source>Faces that get layers; none: all outer faces. With a solid among them, only inside that solid</source>
      <translation>Flächen, die Schichten bekommen; keine: alle äußeren Flächen. Mit einem Körper unter ihnen nur in diesem Körper</translation>
    </message>
    <message>
      <source>Features that meet below this angle form a crease and get a collar</source>
      <translation>Merkmale, die sich unter einem kleineren Winkel treffen, bilden einen Falz und bekommen einen Kragen</translation>
    </message>
    <message>
      <source>Finer parts of the mesh</source>
      <translation>Feinere Teile des Netzes</translation>
    </message>
    <message>
      <source>Give each solid nodes of its own where solids touch, for contact; otherwise they are glued</source>
      <translation>Jedem Körper eigene Knoten geben, wo Körper sich berühren, für Kontakt; sonst sind sie verklebt</translation>
    </message>
    <message>
      <source>Groups of the mesh</source>
      <translation>Gruppen des Netzes</translation>
    </message>
    <message>
      <source>Growth of size per unit length away from finer features; 0: unlimited</source>
      <translation>Wachstum der Größe je Längeneinheit, von feineren Merkmalen weg; 0: unbegrenzt</translation>
    </message>
    <message>
      <source>Growth of size per unit length away from there</source>
      <translation>Wachstum der Größe je Längeneinheit, von dort weg</translation>
    </message>
    <message>
      <source>Height of all layers, in place of the first height; 0: none</source>
      <translation>Höhe aller Schichten, anstelle der ersten Höhe; 0: keine</translation>
    </message>
    <message>
      <source>Height of the box along its z axis</source>
      <translation>Höhe des Quaders entlang seiner z-Achse</translation>
    </message>
    <message>
      <source>Height of the cylinder along its z axis</source>
      <translation>Höhe des Zylinders entlang seiner z-Achse</translation>
    </message>
    <message>
      <source>Height of the first layer; 0: a tenth of the edges there</source>
      <translation>Höhe der ersten Schicht; 0: ein Zehntel der Kanten dort</translation>
    </message>
    <message>
      <source>Improve tetrahedra with smaller dihedral angles; 0: 15, 20, 30 by level</source>
      <translation>Tetraeder mit kleineren Diederwinkeln verbessern; 0: 15, 20, 30 je nach Stufe</translation>
    </message>
    <message>
      <source>Inner faces whose nodes are made twice, one for each side, as for cracks: Face7</source>
      <translation>Flächen im Innern, deren beide Seiten eigene Knoten bekommen, wie bei Rissen: Face7</translation>
    </message>
    <message>
      <source>Insert nodes so that no tetrahedron has all corners on boundaries, interfaces or internal patches</source>
      <translation>Knoten einfügen, sodass kein Tetraeder alle Ecken auf Rändern, Grenzflächen oder inneren Flächen hat</translation>
    </message>
    <message>
      <source>Largest distance from smooth surfaces and curves; 0: 1/10 of the size, less where the part is thin</source>
      <translation>Größter Abstand von glatten Flächen und Kurven; 0: 1/10 der Größe, weniger, wo das Teil dünn ist</translation>
    </message>
    <message>
      <source>Length of the box along its x axis</source>
      <translation>Länge des Quaders entlang seiner x-Achse</translation>
    </message>
    <message>
      <source>Make a volume of a surface that is open, by filling its holes</source>
      <translation>Aus einer offenen Fläche ein Volumen machen, indem ihre Löcher gefüllt werden</translation>
    </message>
    <message>
      <source>Maximum wall time in seconds, from reading to writing; 0: none</source>
      <translation>Längste Dauer in Sekunden, vom Lesen bis zum Schreiben; 0: unbegrenzt</translation>
    </message>
    <message>
      <source>Neighbouring facets within this distance of one plane form one patch, relative to the diagonal; 0: 1e-06</source>
      <translation>Benachbarte Facetten, die höchstens so weit von einer Ebene entfernt sind, bilden eine Fläche, relativ zur Diagonale; 0: 1e-06</translation>
    </message>
    <message>
      <source>Number of layers</source>
      <translation>Anzahl der Schichten</translation>
    </message>
    <message>
      <source>Number of the mesh that the object has</source>
      <translation>Welches seiner Netze das Objekt hat</translation>
    </message>
    <message>
      <source>Order of the elements</source>
      <translation>Elementordnung</translation>
    </message>
    <message>
      <source>Pairs of sides that get the same nodes and triangles: x, y, z, Face1=Face2, Face1=Face2:rotation,z,60</source>
      <translation>Paare von Seiten, die dieselben Knoten und Dreiecke bekommen: x, y, z, Face1=Face2, Face1=Face2:rotation,z,60</translation>
    </message>
    <message>
      <source>Points closer than this are merged, relative to the diagonal; 0: 1e-09</source>
      <translation>Punkte, die näher beieinander liegen, werden einer, relativ zur Diagonale; 0: 1e-09</translation>
    </message>
    <message>
      <source>Radius of the cylinder</source>
      <translation>Radius des Zylinders</translation>
    </message>
    <message>
      <source>Radius of the sphere</source>
      <translation>Radius der Kugel</translation>
    </message>
    <message>
      <source>Ratio of the heights of a layer and the one below it, 1 to 10</source>
      <translation>Verhältnis der Höhen einer Schicht und der darunter, 1 bis 10</translation>
    </message>
    <message>
      <source>Refine where smooth surfaces and edges curve: N elements per full circle; 0: none</source>
      <translation>Verfeinern, wo glatte Flächen und Kanten sich krümmen: N Elemente je vollem Kreis; 0: nicht</translation>
    </message>
    <message>
      <source>Refine where surfaces face each other across a thin part: N elements between them; 0: none</source>
      <translation>Verfeinern, wo Flächen einander quer durch einen dünnen Teil gegenüberliegen: N Elemente dazwischen; 0: nicht</translation>
    </message>
    <message>
      <source>Removal of slivers: 0 none; 1 quick: angles below 15 degrees, vertices stay; 2 good: below 20; 3 best: below 30</source>
      <translation>Entfernen flacher Elemente: 0 keines; 1 schnell: Winkel unter 15 Grad, Knoten bleiben; 2 gut: unter 20; 3 am besten: unter 30</translation>
    </message>
    <message>
      <source>Repair treats features smaller than this as noise, relative to the diagonal; 0: 1e-05</source>
      <translation>Die Reparatur behandelt kleinere Merkmale als Rauschen, relativ zur Diagonale; 0: 1e-05</translation>
    </message>
    <message>
      <source>Seed of the pseudo-random offsets</source>
      <translation>Startwert der Pseudozufallszahlen</translation>
    </message>
    <message>
      <source>Sizes and layers of collarmesh</source>
      <translation>Größen und Schichten von collarmesh</translation>
    </message>
    <message>
      <source>Sizes in spheres, boxes and cylinders and near faces and edges</source>
      <translation>Größen in Kugeln, Quadern und Zylindern und nahe Flächen und Kanten</translation>
    </message>
    <message>
      <source>Smallest target edge length; smaller local sizes are raised to it; 0: none</source>
      <translation>Kleinste angestrebte Kantenlänge; kleinere örtliche Größen werden auf sie angehoben; 0: keine</translation>
    </message>
    <message>
      <source>Target edge length everywhere; 0: 1/20 of the diagonal</source>
      <translation>Angestrebte Kantenlänge überall; 0: 1/20 der Diagonale</translation>
    </message>
    <message>
      <source>Target edge length inside</source>
      <translation>Angestrebte Kantenlänge darin</translation>
    </message>
    <message>
      <source>The group of each face</source>
      <translation>Die Gruppe jeder Fläche</translation>
    </message>
    <message>
      <source>The mesh whose groups these faces stand for</source>
      <translation>Das Netz, für dessen Gruppen diese Flächen stehen</translation>
    </message>
    <message>
      <source>The object whose shape is meshed</source>
      <translation>Das Objekt, dessen Form vernetzt wird</translation>
    </message>
    <message>
      <source>The settings that the mesh was made with</source>
      <translation>Mit welchen Einstellungen es gemacht ist</translation>
    </message>
    <message>
      <source>The shape that the mesh was made from</source>
      <translation>Aus welcher Form das Netz gemacht ist</translation>
    </message>
    <message>
      <source>The size holds up to this distance and grows beyond</source>
      <translation>Die Größe gilt bis zu diesem Abstand und wächst jenseits davon</translation>
    </message>
    <message>
      <source>What to do with triangles of the shape that intersect or leave holes. Automatic: repair them; None: refuse them; Wrap: where repair fails, mesh a closed surface around everything</source>
      <translation>Was mit Dreiecken der Form geschieht, die sich schneiden oder Löcher lassen. Automatic: reparieren; None: ablehnen; Wrap: wo die Reparatur scheitert, eine geschlossene Hülle um alles vernetzen</translation>
    </message>
    <message>
      <source>Width of the box along its y axis</source>
      <translation>Breite des Quaders entlang seiner y-Achse</translation>
    </message>
    <message>
      <source>on: as few tetrahedra as the sizes ask for, thin ones in thin places; off: the bound on circumradius / shortest edge holds everywhere outside collars</source>
      <translation>an: so wenige Tetraeder, wie die Größen verlangen, dünne an dünnen Stellen; aus: die Schranke für Umkugelradius / kürzeste Kante gilt überall außerhalb der Kragen</translation>
    </message>
  </context>
  <context>
    <name>collarmesh</name>
    <message>
      <source> mm per mm</source>
      <translation> mm je mm</translation>
    </message>
    <message>
      <source>'{text}' is negative</source>
      <translation>„{text}“ ist negativ</translation>
    </message>
    <message>
      <source>'{text}' is no number</source>
      <translation>„{text}“ ist keine Zahl</translation>
    </message>
    <message>
      <source>'{text}' is no value</source>
      <translation>„{text}“ ist kein Wert</translation>
    </message>
    <message>
      <source>'{text}' is not in {unit}</source>
      <translation>„{text}“ ist nicht in {unit}</translation>
    </message>
    <message>
      <source>'{text}' is too large</source>
      <translation>„{text}“ ist zu groß</translation>
    </message>
    <message>
      <source>1D: lines, for beams</source>
      <translation>1D: Linien, für Balken</translation>
    </message>
    <message>
      <source>2D: triangles, for shells</source>
      <translation>2D: Dreiecke, für Schalen</translation>
    </message>
    <message>
      <source>3D: tetrahedra</source>
      <translation>3D: Tetraeder</translation>
    </message>
    <message>
      <source>&lt; 1 s</source>
      <translation>&lt; 1 s</translation>
    </message>
    <message>
      <source>&lt;b&gt;{lines}&lt;/b&gt; lines, &lt;b&gt;{nodes}&lt;/b&gt; nodes, in {time}</source>
      <translation>&lt;b&gt;{lines}&lt;/b&gt; Linien, &lt;b&gt;{nodes}&lt;/b&gt; Knoten, in {time}</translation>
    </message>
    <message>
      <source>&lt;b&gt;{tets}&lt;/b&gt; tetrahedra, &lt;b&gt;{nodes}&lt;/b&gt; nodes, &lt;b&gt;{faces}&lt;/b&gt; faces</source>
      <translation>&lt;b&gt;{tets}&lt;/b&gt; Tetraeder, &lt;b&gt;{nodes}&lt;/b&gt; Knoten, &lt;b&gt;{faces}&lt;/b&gt; Flächen</translation>
    </message>
    <message>
      <source>&lt;b&gt;{triangles}&lt;/b&gt; triangles, &lt;b&gt;{nodes}&lt;/b&gt; nodes</source>
      <translation>&lt;b&gt;{triangles}&lt;/b&gt; Dreiecke, &lt;b&gt;{nodes}&lt;/b&gt; Knoten</translation>
    </message>
    <message>
      <source>A guarantee is missed</source>
      <translation>Eine Zusage ist verfehlt</translation>
    </message>
    <message>
      <source>A guarantee was missed when the mesh was made</source>
      <translation>Eine Zusage war verfehlt, als es entstand</translation>
    </message>
    <message>
      <source>A hole of the shape is filled, with {area} mm²; the list has its place.</source>
      <translation>Ein Loch der Form ist mit {area} mm² gefüllt; die Liste sagt, wo.</translation>
    </message>
    <message>
      <source>A node inside of each element</source>
      <translation>Ein Knoten im Innern jedes Elements</translation>
    </message>
    <message>
      <source>Add the selected</source>
      <translation>Ausgewählte hinzufügen</translation>
    </message>
    <message>
      <source>Advanced</source>
      <translation>Erweitert</translation>
    </message>
    <message>
      <source>All layers together are {height} mm high.</source>
      <translation>Alle Schichten zusammen sind {height} mm hoch.</translation>
    </message>
    <message>
      <source>Another panel is open; close it first.</source>
      <translation>Ein anderes Aufgabenfenster ist offen; schließen Sie es zuerst.</translation>
    </message>
    <message>
      <source>As few elements as the sizes ask for</source>
      <translation>So wenige Elemente, wie die Größen verlangen</translation>
    </message>
    <message>
      <source>Ask for a smaller size in a box, which can be dragged and turned in the 3D view</source>
      <translation>Eine kleinere Größe in einem Quader verlangen, der sich in der 3D-Ansicht ziehen und drehen lässt</translation>
    </message>
    <message>
      <source>Ask for a smaller size in a cylinder, which can be dragged and turned in the 3D view</source>
      <translation>Eine kleinere Größe in einem Zylinder verlangen, der sich in der 3D-Ansicht ziehen und drehen lässt</translation>
    </message>
    <message>
      <source>Ask for a smaller size in a sphere, which can be dragged in the 3D view; select faces to put it there</source>
      <translation>Eine kleinere Größe in einer Kugel verlangen, die sich in der 3D-Ansicht ziehen lässt; an ausgewählte Flächen wird sie gesetzt</translation>
    </message>
    <message>
      <source>Ask for a smaller size on faces, edges or solids in the selected collarmesh mesh</source>
      <translation>Eine kleinere Größe auf Flächen, Kanten oder Körpern im ausgewählten Netz von collarmesh verlangen</translation>
    </message>
    <message>
      <source>Ask for a smaller size within a distance from the selected faces and edges</source>
      <translation>Eine kleinere Größe bis zu einem Abstand von den ausgewählten Flächen und Kanten verlangen</translation>
    </message>
    <message>
      <source>Ask for thin layers of prisms along the selected faces, for flow, heat and currents at walls</source>
      <translation>Dünne Schichten aus Prismen an den gewählten Flächen verlangen, für Strömung, Wärme und Ströme an Wänden</translation>
    </message>
    <message>
      <source>Boundary layers</source>
      <translation>Randschichten</translation>
    </message>
    <message>
      <source>Boundary layers of Gmsh on edges, which collarmesh does not have: {names}</source>
      <translation>Randschichten von Gmsh an Kanten, die collarmesh nicht hat: {names}</translation>
    </message>
    <message>
      <source>Cancel</source>
      <translation>Abbrechen</translation>
    </message>
    <message>
      <source>Cancelled; the previous mesh is kept.</source>
      <translation>Abgebrochen; das bisherige Netz bleibt.</translation>
    </message>
    <message>
      <source>Choose a size; how many elements it makes and how long that takes is estimated for this shape</source>
      <translation>Wählen Sie eine Größe; wie viele Elemente sie ergibt und wie lange das dauert, ist für diese Form geschätzt</translation>
    </message>
    <message>
      <source>Circumradius / shortest edge</source>
      <translation>Umkugelradius / kürzeste Kante</translation>
    </message>
    <message>
      <source>Circumradius / shortest edge is bounded</source>
      <translation>Umkugelradius / kürzeste Kante ist beschränkt</translation>
    </message>
    <message>
      <source>Click to see the place</source>
      <translation>Klicken zeigt die Stelle</translation>
    </message>
    <message>
      <source>Coarse</source>
      <translation>Grob</translation>
    </message>
    <message>
      <source>Collars have no large angle</source>
      <translation>Kragen haben keine großen Winkel</translation>
    </message>
    <message>
      <source>Curved elements are not inverted</source>
      <translation>Gekrümmte Elemente sind nicht umgestülpt</translation>
    </message>
    <message>
      <source>Custom</source>
      <translation>Eigene</translation>
    </message>
    <message>
      <source>Dimension of the elements</source>
      <translation>Dimension der Elemente</translation>
    </message>
    <message>
      <source>Drag the handles in the 3D view. To turn it, close this panel and choose Transform in its context menu.</source>
      <translation>Ziehen Sie an den Griffen in der 3D-Ansicht. Zum Drehen schließen Sie dieses Fenster und wählen Transformieren im Kontextmenü.</translation>
    </message>
    <message>
      <source>Each element has a node inside of its solid</source>
      <translation>Jedes Element hat einen Knoten im Inneren seines Körpers</translation>
    </message>
    <message>
      <source>Each is thicker by the factor</source>
      <translation>Jede ist dicker um den Faktor</translation>
    </message>
    <message>
      <source>Each solid has its volume, no element is inverted</source>
      <translation>Jeder Körper hat sein Volumen, kein Element ist umgestülpt</translation>
    </message>
    <message>
      <source>Edit mesh</source>
      <translation>Netz bearbeiten</translation>
    </message>
    <message>
      <source>Element size</source>
      <translation>Elementgröße</translation>
    </message>
    <message>
      <source>Elements</source>
      <translation>Elemente</translation>
    </message>
    <message>
      <source>Elements across gaps</source>
      <translation>Elemente quer durch Dünnes</translation>
    </message>
    <message>
      <source>Elements name the shape's edges that they lie on</source>
      <translation>Elemente kennen ihre Kanten</translation>
    </message>
    <message>
      <source>Elements name the shape's faces and edges that they lie on</source>
      <translation>Elemente kennen ihre Flächen und Kanten</translation>
    </message>
    <message>
      <source>Elements of layers are not inverted and meet in whole sides</source>
      <translation>Elemente der Schichten sind nicht umgestülpt und haben ganze Seiten gemeinsam</translation>
    </message>
    <message>
      <source>Elements of new meshes</source>
      <translation>Elemente neuer Netze</translation>
    </message>
    <message>
      <source>Elements on a full circle</source>
      <translation>Elemente auf einem vollen Kreis</translation>
    </message>
    <message>
      <source>End the run; the mesh stays as it is</source>
      <translation>Den Lauf beenden; das Netz bleibt, wie es ist</translation>
    </message>
    <message>
      <source>Error to aim for, relative to the energy norm of the solution</source>
      <translation>Angestrebter Fehler, relativ zur Energienorm der Lösung</translation>
    </message>
    <message>
      <source>Every guarantee held when the mesh was made</source>
      <translation>Alle Zusagen waren eingehalten, als es entstand</translation>
    </message>
    <message>
      <source>Every guarantee holds</source>
      <translation>Alle Zusagen sind eingehalten</translation>
    </message>
    <message>
      <source>Export mesh</source>
      <translation>Netz exportieren</translation>
    </message>
    <message>
      <source>Export mesh...</source>
      <translation>Netz exportieren...</translation>
    </message>
    <message>
      <source>FEM mesh from shape by collarmesh</source>
      <translation>FEM-Netz aus einer Form mit collarmesh</translation>
    </message>
    <message>
      <source>Faces for constraints</source>
      <translation>Flächen für Randbedingungen</translation>
    </message>
    <message>
      <source>Faces of {part}</source>
      <translation>Flächen von {part}</translation>
    </message>
    <message>
      <source>Faces to split</source>
      <translation>Aufzutrennende Flächen</translation>
    </message>
    <message>
      <source>Faces with layers: type their names, or select them in the 3D view and add them. With a solid among them, layers are inside that solid only.</source>
      <translation>Flächen mit Schichten: ihre Namen eingeben, oder sie in der 3D-Ansicht wählen und hinzufügen. Mit einem Körper unter ihnen gibt es Schichten nur in diesem Körper.</translation>
    </message>
    <message>
      <source>Fill holes of open surfaces</source>
      <translation>Löcher offener Flächen füllen</translation>
    </message>
    <message>
      <source>Fill the holes</source>
      <translation>Löcher füllen</translation>
    </message>
    <message>
      <source>Fine</source>
      <translation>Fein</translation>
    </message>
    <message>
      <source>Fineness</source>
      <translation>Feinheit</translation>
    </message>
    <message>
      <source>First height</source>
      <translation>Erste Höhe</translation>
    </message>
    <message>
      <source>First order is too stiff for bending: displacements come out too small, and stresses far too small. It is for a first look, and for solvers that ask for it.</source>
      <translation>Die erste Ordnung ist zu steif bei Biegung: Verschiebungen werden zu klein, Spannungen viel zu klein. Sie ist für einen ersten Blick, und für Löser, die sie verlangen.</translation>
    </message>
    <message>
      <source>Found no browser to show the report; it is in {path}</source>
      <translation>Kein Browser gefunden, der den Bericht zeigt; er liegt in {path}</translation>
    </message>
    <message>
      <source>FreeCAD's Gmsh cannot mesh triangle meshes.</source>
      <translation>Gmsh kann in FreeCAD keine Dreiecksnetze vernetzen.</translation>
    </message>
    <message>
      <source>From shape: tetrahedra in what encloses a volume, triangles on faces and open surfaces, lines on wires</source>
      <translation>Nach der Form: Tetraeder in dem, was ein Volumen umschließt, Dreiecke auf einzelnen und offenen Flächen, Linien auf Drahtzügen</translation>
    </message>
    <message>
      <source>Give each solid nodes of its own where solids touch, for contact and tie constraints; otherwise they are glued</source>
      <translation>Jedem Körper eigene Knoten geben, wo Körper sich berühren, für Kontakt- und Verbindungsbedingungen; sonst sind sie verklebt</translation>
    </message>
    <message>
      <source>Give either a number of elements or an error, more than 0.</source>
      <translation>Entweder eine Zahl von Elementen oder einen Fehler angeben, größer als 0.</translation>
    </message>
    <message>
      <source>Gmsh ignores these sizes and layers: {names}</source>
      <translation>Gmsh beachtet diese Größen und Schichten nicht: {names}</translation>
    </message>
    <message>
      <source>Group of a collarmesh mesh</source>
      <translation>Gruppe eines Netzes von collarmesh</translation>
    </message>
    <message>
      <source>Groups</source>
      <translation>Gruppen</translation>
    </message>
    <message>
      <source>Growth away from it</source>
      <translation>Wachstum davon weg</translation>
    </message>
    <message>
      <source>Growth of the size</source>
      <translation>Wachstum der Größe</translation>
    </message>
    <message>
      <source>Hand over to Gmsh</source>
      <translation>An Gmsh übergeben</translation>
    </message>
    <message>
      <source>Height</source>
      <translation>Höhe</translation>
    </message>
    <message>
      <source>Holds within</source>
      <translation>Gilt bis zum Abstand</translation>
    </message>
    <message>
      <source>How much time goes into removing flat elements</source>
      <translation>Wie viel Zeit ins Entfernen flacher Elemente geht</translation>
    </message>
    <message>
      <source>Improve below this angle</source>
      <translation>Unter diesem Winkel verbessern</translation>
    </message>
    <message>
      <source>Improvement</source>
      <translation>Verbesserung</translation>
    </message>
    <message>
      <source>Improvement of new meshes</source>
      <translation>Verbesserung neuer Netze</translation>
    </message>
    <message>
      <source>In all layers of this mesh, for solvers that accept only tetrahedra</source>
      <translation>In allen Schichten dieses Netzes, für Löser, die nichts anderes kennen</translation>
    </message>
    <message>
      <source>Inner faces whose nodes are made twice, one for each side, as for cracks; their names, with spaces between them</source>
      <translation>Flächen im Innern, deren beide Seiten eigene Knoten bekommen, wie bei Rissen; ihre Namen, durch Leerzeichen getrennt</translation>
    </message>
    <message>
      <source>Keep touching solids apart</source>
      <translation>Körper, die sich berühren, getrennt lassen</translation>
    </message>
    <message>
      <source>Largest angle in collars</source>
      <translation>Größter Winkel in Kragen</translation>
    </message>
    <message>
      <source>Largest dihedral angle</source>
      <translation>Größter Diederwinkel</translation>
    </message>
    <message>
      <source>Largest distance from the shape</source>
      <translation>Größter Abstand von der Form</translation>
    </message>
    <message>
      <source>Largest number of threads; the result does not depend on it</source>
      <translation>Größte Anzahl der Threads; das Ergebnis hängt nicht davon ab</translation>
    </message>
    <message>
      <source>Layers keep the faces and the volumes of solids</source>
      <translation>Schichten behalten die Flächen und die Volumen der Körper bei</translation>
    </message>
    <message>
      <source>Layers: &lt;b&gt;{prisms}&lt;/b&gt; prisms, {pyramids} pyramids and {tets} tetrahedra cover {percent}% of the faces</source>
      <translation>Schichten: &lt;b&gt;{prisms}&lt;/b&gt; Prismen, {pyramids} Pyramiden und {tets} Tetraeder bedecken {percent}% der Flächen</translation>
    </message>
    <message>
      <source>Length</source>
      <translation>Länge</translation>
    </message>
    <message>
      <source>Lines</source>
      <translation>Linien</translation>
    </message>
    <message>
      <source>Lower layers ({count})</source>
      <translation>Niedrigere Schichten ({count})</translation>
    </message>
    <message>
      <source>Make a mesh of the selected solid, surface or wire, certified, with groups for its faces, or open the one that is there</source>
      <translation>Aus dem gewählten Volumenkörper, der Fläche oder dem Drahtzug ein geprüftes Netz mit Gruppen für die Flächen machen, oder das vorhandene öffnen</translation>
    </message>
    <message>
      <source>Make the mesh finer where the error of the stresses in a result is large, and coarser where it is small</source>
      <translation>Das Netz verfeinern, wo der Fehler der Spannungen in einem Ergebnis groß ist, und vergröbern, wo er klein ist</translation>
    </message>
    <message>
      <source>Make the mesh finer where the error of the stresses is large, and coarser where it is small</source>
      <translation>Das Netz verfeinern, wo der Fehler der Spannungen groß ist, und vergröbern, wo er klein ist</translation>
    </message>
    <message>
      <source>Make the selected mesh of Gmsh or Netgen one of collarmesh, with its sizes and groups</source>
      <translation>Das ausgewählte Netz von Gmsh oder Netgen zu einem von collarmesh machen, mit seinen Größen und Gruppen</translation>
    </message>
    <message>
      <source>Median edge length</source>
      <translation>Median der Kantenlängen</translation>
    </message>
    <message>
      <source>Medium</source>
      <translation>Mittel</translation>
    </message>
    <message>
      <source>Mesh</source>
      <translation>Vernetzen</translation>
    </message>
    <message>
      <source>Mesh again</source>
      <translation>Neu vernetzen</translation>
    </message>
    <message>
      <source>Mesh all the same</source>
      <translation>Trotzdem vernetzen</translation>
    </message>
    <message>
      <source>Mesh by collarmesh</source>
      <translation>Netz von collarmesh</translation>
    </message>
    <message>
      <source>Name the elements on faces, edges or solids in the selected collarmesh mesh</source>
      <translation>Die Elemente auf Flächen, Kanten oder in Körpern im ausgewählten Netz von collarmesh benennen</translation>
    </message>
    <message>
      <source>No mesh is made; the list says why.</source>
      <translation>Es ist kein Netz entstanden; die Liste sagt, warum.</translation>
    </message>
    <message>
      <source>No two solids touch, so there is nothing to keep apart.</source>
      <translation>Keine zwei Körper berühren sich, es gibt also nichts getrennt zu lassen.</translation>
    </message>
    <message>
      <source>Nodes</source>
      <translation>Knoten</translation>
    </message>
    <message>
      <source>Nodes off their face ({count})</source>
      <translation>Knoten neben ihrer Fläche ({count})</translation>
    </message>
    <message>
      <source>Number of elements to aim for</source>
      <translation>Angestrebte Zahl der Elemente</translation>
    </message>
    <message>
      <source>Number of layers</source>
      <translation>Anzahl der Schichten</translation>
    </message>
    <message>
      <source>Open a page with all measurements and a view of the mesh</source>
      <translation>Eine Seite mit allen Messwerten und einer Ansicht des Netzes öffnen</translation>
    </message>
    <message>
      <source>Or set “Fill holes of open surfaces”.</source>
      <translation>Oder setzen Sie „Löcher offener Flächen füllen“.</translation>
    </message>
    <message>
      <source>Order of the elements</source>
      <translation>Elementordnung</translation>
    </message>
    <message>
      <source>Pairs of sides that get the same nodes and triangles, with spaces between them: x y z, or Face1=Face2</source>
      <translation>Paare von Seiten, die dieselben Knoten und Dreiecke bekommen, durch Leerzeichen getrennt: x y z oder Face1=Face2</translation>
    </message>
    <message>
      <source>Periodic faces</source>
      <translation>Periodische Flächen</translation>
    </message>
    <message>
      <source>Periodic faces have the same nodes, edges and triangles</source>
      <translation>Periodische Flächen haben dieselben Knoten, Kanten und Dreiecke</translation>
    </message>
    <message>
      <source>Poisson's ratio {text} of the material is no number: correct it.</source>
      <translation>Die Querkontraktionszahl {text} des Materials ist keine Zahl: korrigieren Sie sie.</translation>
    </message>
    <message>
      <source>Position {axis}</source>
      <translation>Position {axis}</translation>
    </message>
    <message>
      <source>Problems ({count})</source>
      <translation>Probleme ({count})</translation>
    </message>
    <message>
      <source>Program collarmesh</source>
      <translation>Programm collarmesh</translation>
    </message>
    <message>
      <source>Quality</source>
      <translation>Güte</translation>
    </message>
    <message>
      <source>Radius</source>
      <translation>Radius</translation>
    </message>
    <message>
      <source>Refine</source>
      <translation>Verfeinern</translation>
    </message>
    <message>
      <source>Refine all the same</source>
      <translation>Trotzdem verfeinern</translation>
    </message>
    <message>
      <source>Refine by result</source>
      <translation>Nach Ergebnis verfeinern</translation>
    </message>
    <message>
      <source>Refinement of a collarmesh mesh</source>
      <translation>Verfeinerung eines Netzes von collarmesh</translation>
    </message>
    <message>
      <source>Refinements of Gmsh that collarmesh does not have: {names}</source>
      <translation>Verfeinerungen von Gmsh, die collarmesh nicht hat: {names}</translation>
    </message>
    <message>
      <source>Region {number}</source>
      <translation>Gebiet {number}</translation>
    </message>
    <message>
      <source>Remove</source>
      <translation>Entfernen</translation>
    </message>
    <message>
      <source>Repair of the shape</source>
      <translation>Reparatur der Form</translation>
    </message>
    <message>
      <source>Repaired ({count})</source>
      <translation>Repariert ({count})</translation>
    </message>
    <message>
      <source>Report</source>
      <translation>Bericht</translation>
    </message>
    <message>
      <source>Run</source>
      <translation>Lauf</translation>
    </message>
    <message>
      <source>Second order: mid-edge nodes, on the exact faces</source>
      <translation>Zweite Ordnung: Knoten mitten auf den Kanten, auf den exakten Flächen</translation>
    </message>
    <message>
      <source>Seed</source>
      <translation>Startzahl</translation>
    </message>
    <message>
      <source>Select faces and edges in the 3D view, then add them:</source>
      <translation>Flächen und Kanten in der 3D-Ansicht auswählen, dann hinzufügen:</translation>
    </message>
    <message>
      <source>Settings of Gmsh that collarmesh does not have: {names}</source>
      <translation>Einstellungen von Gmsh, die collarmesh nicht hat: {names}</translation>
    </message>
    <message>
      <source>Shape</source>
      <translation>Form</translation>
    </message>
    <message>
      <source>Sharp below this angle</source>
      <translation>Spitz unter diesem Winkel</translation>
    </message>
    <message>
      <source>Show a face for each group of this mesh of triangles, for the constraints of FEM</source>
      <translation>Für jede Gruppe dieses Dreiecksnetzes eine Fläche zeigen, für die Randbedingungen von FEM</translation>
    </message>
    <message>
      <source>Show sizes</source>
      <translation>Größen zeigen</translation>
    </message>
    <message>
      <source>Size</source>
      <translation>Größe</translation>
    </message>
    <message>
      <source>Size in a box</source>
      <translation>Größe in einem Quader</translation>
    </message>
    <message>
      <source>Size in a cylinder</source>
      <translation>Größe in einem Zylinder</translation>
    </message>
    <message>
      <source>Size in a sphere</source>
      <translation>Größe in einer Kugel</translation>
    </message>
    <message>
      <source>Size near faces and edges</source>
      <translation>Größe nahe Flächen und Kanten</translation>
    </message>
    <message>
      <source>Size of the elements</source>
      <translation>Größe der Elemente</translation>
    </message>
    <message>
      <source>Sizes</source>
      <translation>Größen</translation>
    </message>
    <message>
      <source>Smallest dihedral angle</source>
      <translation>Kleinster Diederwinkel</translation>
    </message>
    <message>
      <source>Smallest dihedral angle of each tetrahedron</source>
      <translation>Kleinster Diederwinkel jedes Tetraeders</translation>
    </message>
    <message>
      <source>Smallest size</source>
      <translation>Kleinste Größe</translation>
    </message>
    <message>
      <source>Solids that are kept apart share no node, and their faces fit</source>
      <translation>Getrennte Körper haben keinen Knoten gemeinsam, und ihre Flächen passen aufeinander</translation>
    </message>
    <message>
      <source>Statistics of {label}</source>
      <translation>Statistik von {label}</translation>
    </message>
    <message>
      <source>Statistics...</source>
      <translation>Statistik...</translation>
    </message>
    <message>
      <source>Stop</source>
      <translation>Anhalten</translation>
    </message>
    <message>
      <source>Take over by collarmesh</source>
      <translation>Mit collarmesh übernehmen</translation>
    </message>
    <message>
      <source>Target length of the elements' edges</source>
      <translation>Länge, die die Kanten der Elemente haben sollen</translation>
    </message>
    <message>
      <source>Tetrahedra</source>
      <translation>Tetraeder</translation>
    </message>
    <message>
      <source>Tetrahedra beside layers have no small or large angle</source>
      <translation>Tetraeder neben Schichten haben keinen kleinen oder großen Winkel</translation>
    </message>
    <message>
      <source>Tetrahedra in place of prisms</source>
      <translation>Tetraeder anstelle von Prismen</translation>
    </message>
    <message>
      <source>That takes about {time}.</source>
      <translation>Das dauert etwa {time}.</translation>
    </message>
    <message>
      <source>The analysis needs a beam cross section (FEM: Beam cross section).</source>
      <translation>Die Analyse braucht einen Balkenquerschnitt (FEM: Balkenquerschnitt).</translation>
    </message>
    <message>
      <source>The analysis needs a thickness (FEM: Shell plate thickness).</source>
      <translation>Die Analyse braucht eine Dicke (FEM: Schalendicke).</translation>
    </message>
    <message>
      <source>The analysis of {label} has no result with displacements: solve it first.</source>
      <translation>Die Analyse von {label} hat kein Ergebnis mit Verschiebungen: erst lösen.</translation>
    </message>
    <message>
      <source>The first layer is {height} mm high.</source>
      <translation>Die erste Schicht ist {height} mm hoch.</translation>
    </message>
    <message>
      <source>The layers end in {count} pyramids, which FreeCAD has as bricks with equal nodes. Those of second order are inexact in CalculiX: choose tetrahedra in place of prisms, or first order.</source>
      <translation>Die Schichten enden in {count} Pyramiden, die FreeCAD als Quader mit gleichen Knoten hat. Die von zweiter Ordnung sind in CalculiX ungenau: Tetraeder anstelle von Prismen wählen, oder erste Ordnung.</translation>
    </message>
    <message>
      <source>The mesh covers the surface: every face, edge and corner is kept</source>
      <translation>Das Netz bedeckt die Fläche: Jede Fläche, Kante und Ecke ist erhalten</translation>
    </message>
    <message>
      <source>The mesh fills the shape: every face, edge and corner is kept</source>
      <translation>Das Netz füllt die Form: jede Fläche, Kante und Ecke ist erhalten</translation>
    </message>
    <message>
      <source>The mesh follows every edge from end to end</source>
      <translation>Das Netz folgt jeder Kante von Ende zu Ende</translation>
    </message>
    <message>
      <source>The mesh has flat elements, in which there are no strains: mesh the part again.</source>
      <translation>Das Netz hat flache Elemente, in denen es keine Dehnungen gibt: vernetzen Sie das Teil neu.</translation>
    </message>
    <message>
      <source>The mesh has prisms of boundary layers, which are not refined: let the layers be tetrahedra, mesh and solve again.</source>
      <translation>Das Netz hat Prismen von Grenzschichten, die nicht verfeinert werden: wählen Sie Tetraeder für die Schichten, vernetzen und rechnen Sie neu.</translation>
    </message>
    <message>
      <source>The mesh is sound</source>
      <translation>Das Netz ist fehlerfrei</translation>
    </message>
    <message>
      <source>The mesher ended with exit code {code} and without a message.</source>
      <translation>Der Vernetzer endete mit dem Exitcode {code} und ohne ein Wort.</translation>
    </message>
    <message>
      <source>The mesher was cancelled.</source>
      <translation>Der Vernetzer wurde abgebrochen.</translation>
    </message>
    <message>
      <source>The mesher wrote a mesh without elements of the chosen dimension; please report this, with the shape.</source>
      <translation>Der Vernetzer hat ein Netz ohne Elemente der gewählten Dimension geschrieben; bitte melden Sie das mit der Form.</translation>
    </message>
    <message>
      <source>The mesher {path} is no program; correct its path in the preferences.</source>
      <translation>Der Vernetzer {path} ist kein Programm; berichtigen Sie seinen Pfad in den Einstellungen.</translation>
    </message>
    <message>
      <source>The part has changed since the mesh was made: mesh it again and solve it.</source>
      <translation>Das Teil hat sich geändert, seit das Netz gemacht wurde: neu vernetzen und lösen.</translation>
    </message>
    <message>
      <source>The part was changed while it was meshed: this is the mesh of the part as it was before. Mesh it again.</source>
      <translation>Das Teil wurde während des Vernetzens geändert: dies ist das Netz des Teils, wie es vorher war. Vernetzen Sie es neu.</translation>
    </message>
    <message>
      <source>The part was deleted while it was meshed.</source>
      <translation>Das Teil wurde während des Vernetzens gelöscht.</translation>
    </message>
    <message>
      <source>The program collarmesh</source>
      <translation>Das Programm collarmesh</translation>
    </message>
    <message>
      <source>The program collarmesh is not found: install it so that it is on the PATH, or name its path in the preferences.</source>
      <translation>Das Programm collarmesh ist nicht zu finden: Installieren Sie es so, dass es im PATH ist, oder nennen Sie seinen Pfad in den Einstellungen.</translation>
    </message>
    <message>
      <source>The sizes that are asked for, as colours on the part. The mesh is finer where thin places and sharp corners need it</source>
      <translation>Die verlangten Größen als Farben auf dem Teil. Das Netz ist feiner, wo dünne Stellen und scharfe Ecken es brauchen</translation>
    </message>
    <message>
      <source>The solids touch at {count} faces ({names}):</source>
      <translation>Die Körper berühren sich an {count} Flächen ({names}):</translation>
    </message>
    <message>
      <source>The solids touch at {names}:</source>
      <translation>Die Körper berühren sich an {names}:</translation>
    </message>
    <message>
      <source>The worst tetrahedron: {angle}°. Click to see it.</source>
      <translation>Das schlechteste Tetraeder: {angle}°. Klicken zeigt es.</translation>
    </message>
    <message>
      <source>They need about {needed} GB of memory, but {free} GB are free.</source>
      <translation>Sie brauchen etwa {needed} GB Speicher, aber {free} GB sind frei.</translation>
    </message>
    <message>
      <source>They need about {needed} GB of memory.</source>
      <translation>Sie brauchen etwa {needed} GB Speicher.</translation>
    </message>
    <message>
      <source>Thickness of all</source>
      <translation>Dicke aller</translation>
    </message>
    <message>
      <source>Thin elements have no small or large angle</source>
      <translation>Dünne Elemente haben keine kleinen oder großen Winkel</translation>
    </message>
    <message>
      <source>This mesh is out of date: the shape, a size or a setting has changed since it was made. Mesh it again.</source>
      <translation>Dieses Netz ist veraltet: Form, Größe oder eine Einstellung hat sich geändert, seit es entstand. Vernetzen Sie noch einmal.</translation>
    </message>
    <message>
      <source>This size makes about {elements} elements.</source>
      <translation>Diese Größe ergibt etwa {elements} Elemente.</translation>
    </message>
    <message>
      <source>Threads</source>
      <translation>Threads</translation>
    </message>
    <message>
      <source>Time limit in seconds</source>
      <translation>Zeitgrenze in Sekunden</translation>
    </message>
    <message>
      <source>Tolerance of planes</source>
      <translation>Toleranz von Ebenen</translation>
    </message>
    <message>
      <source>Tolerance of points</source>
      <translation>Toleranz von Punkten</translation>
    </message>
    <message>
      <source>Tolerance of repair</source>
      <translation>Toleranz der Reparatur</translation>
    </message>
    <message>
      <source>Triangles</source>
      <translation>Dreiecke</translation>
    </message>
    <message>
      <source>Triangles have no small or large angle</source>
      <translation>Kein Dreieck hat einen kleinen oder großen Winkel</translation>
    </message>
    <message>
      <source>Triangles of a solid look outwards, those of a surface are turned alike</source>
      <translation>Dreiecke eines Volumenkörpers zeigen nach außen, die einer Fläche sind gleich gerichtet</translation>
    </message>
    <message>
      <source>Triangles on faces</source>
      <translation>Dreiecke auf Flächen</translation>
    </message>
    <message>
      <source>Very coarse</source>
      <translation>Sehr grob</translation>
    </message>
    <message>
      <source>Very fine</source>
      <translation>Sehr fein</translation>
    </message>
    <message>
      <source>Volume</source>
      <translation>Volumen</translation>
    </message>
    <message>
      <source>Volumes of the shape and of its mesh. To bring them closer to each other, choose a smaller size or reduce “Largest distance from the shape”</source>
      <translation>Volumen der Form und ihres Netzes. Eine kleinere Größe oder ein kleinerer Wert von „Größter Abstand von der Form“ bringt sie näher zusammen</translation>
    </message>
    <message>
      <source>Warnings ({count})</source>
      <translation>Warnungen ({count})</translation>
    </message>
    <message>
      <source>Width</source>
      <translation>Breite</translation>
    </message>
    <message>
      <source>Worst elements ({count})</source>
      <translation>Schlechteste Elemente ({count})</translation>
    </message>
    <message>
      <source>a tenth of the size</source>
      <translation>ein Zehntel der Größe</translation>
    </message>
    <message>
      <source>about {time} left</source>
      <translation>noch etwa {time}</translation>
    </message>
    <message>
      <source>adapting</source>
      <translation>wird angepasst</translation>
    </message>
    <message>
      <source>all outer faces</source>
      <translation>alle äußeren Flächen</translation>
    </message>
    <message>
      <source>and {count} more</source>
      <translation>und {count} weitere</translation>
    </message>
    <message>
      <source>angles from {smallest}° to {largest}°, in {time}</source>
      <translation>Winkel von {smallest}° bis {largest}°, in {time}</translation>
    </message>
    <message>
      <source>any</source>
      <translation>beliebig</translation>
    </message>
    <message>
      <source>as many as cores</source>
      <translation>so viele wie Kerne</translation>
    </message>
    <message>
      <source>as the sizes ask for</source>
      <translation>wie die Größen verlangen</translation>
    </message>
    <message>
      <source>automatic</source>
      <translation>automatisch</translation>
    </message>
    <message>
      <source>best</source>
      <translation>am besten</translation>
    </message>
    <message>
      <source>boundary layers</source>
      <translation>Randschichten</translation>
    </message>
    <message>
      <source>checking</source>
      <translation>wird geprüft</translation>
    </message>
    <message>
      <source>coarsening</source>
      <translation>wird vergröbert</translation>
    </message>
    <message>
      <source>default</source>
      <translation>Vorgabe</translation>
    </message>
    <message>
      <source>difference</source>
      <translation>Abweichung</translation>
    </message>
    <message>
      <source>dihedral angles from {smallest}° to {largest}°, in {time}</source>
      <translation>Diederwinkel von {smallest}° bis {largest}°, in {time}</translation>
    </message>
    <message>
      <source>faces and edges</source>
      <translation>Flächen und Kanten</translation>
    </message>
    <message>
      <source>first (straight, {n} nodes)</source>
      <translation>erste (gerade, {n} Knoten)</translation>
    </message>
    <message>
      <source>found by itself</source>
      <translation>wird von selbst gefunden</translation>
    </message>
    <message>
      <source>from shape</source>
      <translation>nach der Form</translation>
    </message>
    <message>
      <source>from the first height</source>
      <translation>aus der ersten Höhe</translation>
    </message>
    <message>
      <source>good</source>
      <translation>gut</translation>
    </message>
    <message>
      <source>improving</source>
      <translation>wird verbessert</translation>
    </message>
    <message>
      <source>in mm³</source>
      <translation>in mm³</translation>
    </message>
    <message>
      <source>in the mesh</source>
      <translation>im Netz</translation>
    </message>
    <message>
      <source>it has to be more than 0</source>
      <translation>der Wert muss größer als 0 sein</translation>
    </message>
    <message>
      <source>it takes longer than was estimated</source>
      <translation>es dauert länger als geschätzt</translation>
    </message>
    <message>
      <source>largest angle</source>
      <translation>größter Winkel</translation>
    </message>
    <message>
      <source>loading the mesh</source>
      <translation>Netz wird geladen</translation>
    </message>
    <message>
      <source>making elements</source>
      <translation>macht Elemente</translation>
    </message>
    <message>
      <source>more than a year</source>
      <translation>mehr als ein Jahr</translation>
    </message>
    <message>
      <source>no limit</source>
      <translation>keine Grenze</translation>
    </message>
    <message>
      <source>none</source>
      <translation>keine</translation>
    </message>
    <message>
      <source>none, refuse</source>
      <translation>keine, ablehnen</translation>
    </message>
    <message>
      <source>onto the exact faces</source>
      <translation>auf die exakten Flächen</translation>
    </message>
    <message>
      <source>quick</source>
      <translation>schnell</translation>
    </message>
    <message>
      <source>reading the shape</source>
      <translation>Form wird gelesen</translation>
    </message>
    <message>
      <source>repairing</source>
      <translation>wird repariert</translation>
    </message>
    <message>
      <source>second (curved, {n} nodes)</source>
      <translation>zweite (gekrümmt, {n} Knoten)</translation>
    </message>
    <message>
      <source>second order</source>
      <translation>zweite Ordnung</translation>
    </message>
    <message>
      <source>smallest angle</source>
      <translation>kleinster Winkel</translation>
    </message>
    <message>
      <source>the whole object</source>
      <translation>das ganze Objekt</translation>
    </message>
    <message>
      <source>there is no value</source>
      <translation>es steht kein Wert da</translation>
    </message>
    <message>
      <source>they are glued there, and share the nodes.</source>
      <translation>sie sind dort verklebt und haben die Knoten gemeinsam.</translation>
    </message>
    <message>
      <source>they are kept apart there, each with nodes of its own.</source>
      <translation>sie bleiben dort getrennt, jeder mit eigenen Knoten.</translation>
    </message>
    <message>
      <source>wrap where it fails</source>
      <translation>umhüllen, wo sie scheitert</translation>
    </message>
    <message>
      <source>writing</source>
      <translation>wird geschrieben</translation>
    </message>
    <message>
      <source>{angle}° in element {number}</source>
      <translation>{angle}° in Element {number}</translation>
    </message>
    <message>
      <source>{constraint} is on the group {name}, which the new mesh does not have; choose another one.</source>
      <translation>{constraint} liegt auf der Gruppe {name}, die das neue Netz nicht hat; wählen Sie eine andere.</translation>
    </message>
    <message>
      <source>{count} holes of the shape are filled, the largest with {area} mm²; the list has their places.</source>
      <translation>{count} Löcher der Form sind gefüllt, das größte mit {area} mm²; die Liste sagt, wo.</translation>
    </message>
    <message>
      <source>{edge} at {place} is only {length} mm long, so the mesh becomes very fine there: remove the edge if it is not meant (Part: Defeaturing)</source>
      <translation>{edge} bei {place} ist nur {length} mm lang, dort wird das Netz sehr fein: entfernen Sie die Kante, wenn sie nicht gewollt ist (Part: Formmerkmal entfernen)</translation>
    </message>
    <message>
      <source>{file} cannot be read ({fault}): solve the analysis again.</source>
      <translation>{file} kann nicht gelesen werden ({fault}): rechnen Sie die Analyse neu.</translation>
    </message>
    <message>
      <source>{label} encloses no volume: it is meshed with triangles, for shells.</source>
      <translation>{label} umschließt kein Volumen und wird mit Dreiecken vernetzt, für Schalen.</translation>
    </message>
    <message>
      <source>{label} has edges only: it is meshed with lines, for beams.</source>
      <translation>{label} hat nur Kanten und wird mit Linien vernetzt, für Balken.</translation>
    </message>
    <message>
      <source>{label} has edges or points only, and encloses no volume: choose 1D in “Dimension of the elements” for beams, or make a solid of it (Part: Sweep).</source>
      <translation>{label} hat nur Kanten oder Punkte und umschließt kein Volumen: Wählen Sie 1D in „Dimension der Elemente“ für Balken, oder machen Sie einen Körper daraus (Part: Sweep).</translation>
    </message>
    <message>
      <source>{label} has no edges to be meshed with lines.</source>
      <translation>{label} hat keine Kanten, die mit Linien vernetzt werden könnten.</translation>
    </message>
    <message>
      <source>{label} has no face to be meshed with triangles: choose 1D in “Dimension of the elements”, or make a face of it (Part: Face from wires).</source>
      <translation>{label} hat keine Fläche, die mit Dreiecken vernetzt werden könnte: Wählen Sie 1D in „Dimension der Elemente“, oder machen Sie eine Fläche daraus (Part: Fläche aus Drahtzügen).</translation>
    </message>
    <message>
      <source>{label} has no faces and edges; choose some, or delete it.</source>
      <translation>{label} hat keine Flächen und Kanten; wählen Sie welche oder löschen Sie es.</translation>
    </message>
    <message>
      <source>{label} has no group of faces called {name}; it has {names}.</source>
      <translation>{label} hat keine Gruppe von Flächen namens {name}; es hat {names}.</translation>
    </message>
    <message>
      <source>{label} has no mesh yet.</source>
      <translation>{label} hat noch kein Netz.</translation>
    </message>
    <message>
      <source>{label} has no shape; recompute it.</source>
      <translation>{label} hat keine Form; berechnen Sie es neu.</translation>
    </message>
    <message>
      <source>{label} has no tetrahedra that a result could refine.</source>
      <translation>{label} hat keine Tetraeder, die ein Ergebnis verfeinern könnte.</translation>
    </message>
    <message>
      <source>{label} has no triangles.</source>
      <translation>{label} hat keine Dreiecke.</translation>
    </message>
    <message>
      <source>{label} is a face, which encloses no volume: choose 2D in “Dimension of the elements” for shells, or make a solid of it (Part: Extrude).</source>
      <translation>{label} ist eine Fläche, die kein Volumen umschließt: Wählen Sie 2D in „Dimension der Elemente“ für Schalen, oder machen Sie einen Körper daraus (Part: Extrudieren).</translation>
    </message>
    <message>
      <source>{label} is a surface that is open at {count} edges, and encloses no volume. Choose 2D in “Dimension of the elements” for shells, or close it and make a solid of it (Part: Shape builder).</source>
      <translation>{label} ist eine Fläche, die an {count} Kanten offen ist und kein Volumen umschließt. Wählen Sie 2D in „Dimension der Elemente“ für Schalen, oder schließen Sie sie und machen Sie einen Körper daraus (Part: Formerstellung).</translation>
    </message>
    <message>
      <source>{label} is no mesh of Gmsh or Netgen.</source>
      <translation>{label} ist kein Netz von Gmsh oder Netgen.</translation>
    </message>
    <message>
      <source>{label} is the result of another mesh: solve the analysis again.</source>
      <translation>{label} ist das Ergebnis eines anderen Netzes: die Analyse neu lösen.</translation>
    </message>
    <message>
      <source>{label} refers to {other}, but {part} is meshed; choose its faces and edges.</source>
      <translation>{label} verweist auf {other}, vernetzt wird aber {part}; wählen Sie dessen Flächen und Kanten.</translation>
    </message>
    <message>
      <source>{label} refers to {other}, but {part} is meshed; choose its faces.</source>
      <translation>{label} verweist auf {other}, aber {part} wird vernetzt; dessen Flächen wählen.</translation>
    </message>
    <message>
      <source>{label} refers to {other}, but {part} is meshed; choose its sub-shapes.</source>
      <translation>{label} verweist auf {other}, vernetzt wird aber {part}; wählen Sie dessen Teilformen.</translation>
    </message>
    <message>
      <source>{label}: Growth is {value}, but must be 0 or more.</source>
      <translation>{label}: Growth ist {value}, muss aber 0 oder mehr sein.</translation>
    </message>
    <message>
      <source>{label}: a size of {size:g} mm makes no sense, it has to be more than 0.</source>
      <translation>{label}: eine Größe von {size:g} mm ist sinnlos, sie muss größer als 0 sein.</translation>
    </message>
    <message>
      <source>{label}: estimated error {error} % of the energy norm, with {elements} elements</source>
      <translation>{label}: geschätzter Fehler {error} % der Energienorm, mit {elements} Elementen</translation>
    </message>
    <message>
      <source>{label}: faces for constraints need a mesh with elements that was made from a triangle mesh.</source>
      <translation>{label}: Flächen für Randbedingungen brauchen ein Netz mit Elementen, das aus einem Dreiecksnetz entstanden ist.</translation>
    </message>
    <message>
      <source>{label}: layers are on both sides of a face, or inside one solid; {count} are chosen.</source>
      <translation>{label}: Schichten liegen auf beiden Seiten einer Fläche oder in einem Körper; {count} sind gewählt.</translation>
    </message>
    <message>
      <source>{label}: no object is chosen to be meshed.</source>
      <translation>{label}: es ist kein Objekt zum Vernetzen gewählt.</translation>
    </message>
    <message>
      <source>{label}: nothing is deformed, so there is no error to estimate.</source>
      <translation>{label}: nichts ist verformt, also gibt es keinen Fehler zu schätzen.</translation>
    </message>
    <message>
      <source>{label}: the mesh has nothing of {name}: it lies inside another solid, or repair has removed it; choose others.</source>
      <translation>{label}: Das Netz hat nichts von {name}: Es liegt in einem anderen Körper, oder die Reparatur hat es entfernt; wählen Sie andere.</translation>
    </message>
    <message>
      <source>{label}: {name} cannot have a size of its own.</source>
      <translation>{label}: {name} kann keine eigene Größe haben.</translation>
    </message>
    <message>
      <source>{label}: {name} is no face and no edge.</source>
      <translation>{label}: {name} ist keine Fläche und keine Kante.</translation>
    </message>
    <message>
      <source>{label}: {name} is no face.</source>
      <translation>{label}: {name} ist keine Fläche.</translation>
    </message>
    <message>
      <source>{label}: {name} is the seam of a face, which the mesh does not have; choose the face.</source>
      <translation>{label}: {name} ist die Naht einer Fläche, die das Netz nicht hat; wählen Sie die Fläche.</translation>
    </message>
    <message>
      <source>{label}: {part} has no {name} any more; choose its faces again.</source>
      <translation>{label}: {part} hat kein {name} mehr; die Flächen neu wählen.</translation>
    </message>
    <message>
      <source>{label}: {part} has no {name} any more; choose its faces and edges again.</source>
      <translation>{label}: {part} hat keine {name} mehr; wählen Sie die Flächen und Kanten neu.</translation>
    </message>
    <message>
      <source>{label}: {property} is {value:g}; it has to be {least} to {most}.</source>
      <translation>{label}: {property} ist {value:g}; möglich ist {least} bis {most}.</translation>
    </message>
    <message>
      <source>{label}: {property} is {value}, but must be positive.</source>
      <translation>{label}: {property} ist {value}, muss aber positiv sein.</translation>
    </message>
    <message>
      <source>{label}: {size:g} mm is less than a hundred thousandth of the part, which is {diagonal:.4g} mm large. Choose a larger size.</source>
      <translation>{label}: {size:g} mm sind weniger als ein Hunderttausendstel des Teils, das {diagonal:.4g} mm groß ist. Wählen Sie eine größere Größe.</translation>
    </message>
    <message>
      <source>{material} has no elements: {part} has none of its solids ({names}); choose solids of {part}.</source>
      <translation>{material} hat keine Elemente: {part} hat keinen seiner Körper ({names}); wählen Sie Körper von {part}.</translation>
    </message>
    <message>
      <source>{n} days</source>
      <translation>{n} Tage</translation>
    </message>
    <message>
      <source>{n} h</source>
      <translation>{n} h</translation>
    </message>
    <message>
      <source>{n} min</source>
      <translation>{n} min</translation>
    </message>
    <message>
      <source>{n} s</source>
      <translation>{n} s</translation>
    </message>
    <message>
      <source>{object}: no new mesh is made</source>
      <translation>{object}: es ist kein neues Netz entstanden</translation>
    </message>
    <message>
      <source>{object}: the mesh is made</source>
      <translation>{object}: das Netz ist fertig</translation>
    </message>
    <message>
      <source>{object}: the mesh is made and shows when the other panel is closed</source>
      <translation>{object}: Das Netz ist fertig und erscheint, wenn das andere Aufgabenfenster geschlossen ist</translation>
    </message>
    <message>
      <source>{program} cannot be started: {error}</source>
      <translation>{program} lässt sich nicht starten: {error}</translation>
    </message>
    <message>
      <source>{smallest}° to {largest}° in element {number}</source>
      <translation>{smallest}° bis {largest}° in Element {number}</translation>
    </message>
    <message>
      <source>{tets} elements so far</source>
      <translation>bisher {tets} Elemente</translation>
    </message>
    <message>
      <source>≈ elements</source>
      <translation>≈ Elemente</translation>
    </message>
    <message>
      <source>≈ error</source>
      <translation>≈ Fehler</translation>
    </message>
    <message>
      <source>≈ time</source>
      <translation>≈ Zeit</translation>
    </message>
  </context>
</TS>
