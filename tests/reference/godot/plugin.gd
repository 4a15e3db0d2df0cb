# Imports the folder that KINEFAB_PREFABS names by Unidot Importer, and prints each node of each scene that comes of it: a line
# "SCENE name", then a line "NODE {...}" a node, all in Godot's world: metres, x the other way than Unity's.
@tool
extends EditorPlugin

const UNIDOT := "res://addons/unidot/"
const QUIET := 10 # looks of the clock in which the editor has to be done with its first scan

var clock := Timer.new()
var looks := 0
var dialog: RefCounted


func _enter_tree() -> void:
	clock.wait_time = 0.2
	clock.autostart = true
	clock.timeout.connect(_look)
	EditorInterface.get_base_control().add_child(clock)


func _look() -> void:
	if dialog == null:
		looks += 1
		if looks > QUIET and not EditorInterface.get_resource_filesystem().is_scanning():
			_import()
	elif dialog.import_finished:
		clock.stop()
		_tell_scenes("res://Assets")
		get_tree().quit()


func _import() -> void:
	var database: Resource = load(UNIDOT + "asset_database.gd").new().get_singleton()
	database.use_text_scenes = true
	dialog = load(UNIDOT + "package_import_dialog.gd").new()
	dialog._show_importer_common()
	dialog.auto_import = true
	dialog._selected_package(OS.get_environment("KINEFAB_PREFABS"))


func _tell_scenes(folder: String) -> void:
	for file in DirAccess.get_files_at(folder):
		if file.ends_with(".prefab.tscn"):
			print("SCENE ", file.trim_suffix(".prefab.tscn"))
			var scene: Node = load(folder.path_join(file)).instantiate()
			EditorInterface.get_base_control().add_child(scene)
			_tell(scene)
			scene.free()
	for inner in DirAccess.get_directories_at(folder):
		_tell_scenes(folder.path_join(inner))


func _tell(node: Node) -> void:
	if node is RigidBody3D:
		_say("body", node, {"mass": node.mass, "kinematic": node.freeze})
	elif node is MeshInstance3D and node.mesh != null:
		_say("mesh", node, _drawn(node))
	elif node is CollisionShape3D:
		_say("collider", node, {})
	for child in node.get_children():
		_tell(child)


func _say(kind: String, node: Node3D, told: Dictionary) -> void:
	var at := node.global_position
	told.merge({"kind": kind, "at": [at.x, at.y, at.z]})
	print("NODE ", JSON.stringify(told, "", true, true))


# Lowest and highest corner, the volume that the triangles enclose (negative where they are wound clockwise, as Godot and Unity
# have them) and the colours, linear.
func _drawn(node: MeshInstance3D) -> Dictionary:
	var low := Vector3.INF
	var high := -Vector3.INF
	var volume := 0.0
	var colors := []
	for surface in node.mesh.get_surface_count():
		var arrays := node.mesh.surface_get_arrays(surface)
		var places: Array = Array(arrays[Mesh.ARRAY_VERTEX]).map(func(v): return node.global_transform * v)
		for place in places:
			low = low.min(place)
			high = high.max(place)
		var corners: PackedInt32Array = arrays[Mesh.ARRAY_INDEX]
		for k in range(0, corners.size(), 3):
			var a: Vector3 = places[corners[k]]
			volume += a.dot(places[corners[k + 1]].cross(places[corners[k + 2]])) / 6.0
		var material := node.get_active_material(surface)
		if material is BaseMaterial3D:
			var color: Color = material.albedo_color.srgb_to_linear()
			colors.append([color.r, color.g, color.b])
	return {
		"low": [low.x, low.y, low.z],
		"high": [high.x, high.y, high.z],
		"volume": volume,
		"colors": colors,
	}
