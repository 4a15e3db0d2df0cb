using System;
using System.Collections.Generic;

namespace UnityEngine
{
    public class Object
    {
        public string name { get; set; }
    }

    public class Component : Object
    {
        public GameObject gameObject { get; internal set; }

        public Transform transform => gameObject.transform;
    }

    public sealed class GameObject : Object
    {
        internal readonly List<Component> Components = new List<Component>();

        public GameObject(string name)
        {
            this.name = name;
            transform = AddComponent<Transform>();
        }

        public Transform transform { get; }

        public bool activeSelf { get; private set; } = true;

        public void SetActive(bool value) => activeSelf = value;

        public T AddComponent<T>() where T : Component
        {
            if (typeof(Joint).IsAssignableFrom(typeof(T)) && GetComponent<Rigidbody>() == null)
            {
                throw new InvalidOperationException("Unity would add a Rigidbody of its own.");
            }

            var component = Activator.CreateInstance<T>();
            component.gameObject = this;
            component.name = name;
            Components.Add(component);
            return component;
        }

        public T GetComponent<T>() => (T)(object)Components.Find(c => c is T);
    }

    public sealed partial class Transform : Component
    {
        private Vector3 _localPosition;
        private Quaternion _localRotation = new Quaternion(0, 0, 0, 1);
        private Vector3 _localScale = new Vector3(1, 1, 1);

        public Transform parent { get; private set; }

        public Vector3 localPosition
        {
            get => _localPosition;
            set => Move(ref _localPosition, value);
        }

        public Quaternion localRotation
        {
            get => _localRotation;
            set => Move(ref _localRotation, value);
        }

        public Vector3 localScale
        {
            get => _localScale;
            set => Move(ref _localScale, value);
        }

        public void SetParent(Transform parent, bool worldPositionStays)
        {
            if (worldPositionStays)
            {
                throw new NotSupportedException("The file's poses are local.");
            }

            var same = this.parent;
            Move(ref same, parent);
            this.parent = parent;
        }

        // Unity: a body that exists already follows only with the next step, or Physics.SyncTransforms.
        private void Move<T>(ref T value, T to)
        {
            if (gameObject.GetComponent<Rigidbody>() != null)
            {
                throw new InvalidOperationException("The body was made at another place.");
            }

            value = to;
        }
    }

    public static class Debug
    {
        internal static readonly List<string> Warnings = new List<string>();

        public static void LogWarning(object message) => Warnings.Add(message.ToString());

        public static void LogWarning(object message, Object context) => LogWarning(message);
    }

    public static class Time
    {
        public static float fixedDeltaTime { get; set; } = 0.02f;
    }
}
