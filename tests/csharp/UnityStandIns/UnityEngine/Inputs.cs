using System;

namespace UnityEngine
{
    public struct Ray
    {
        public Ray(Vector3 origin, Vector3 direction)
        {
            this.origin = origin;
            this.direction = direction.normalized;
        }

        public Vector3 origin { get; set; }

        public Vector3 direction { get; set; }

        public Vector3 GetPoint(float distance) => origin + direction * distance;
    }

    public sealed class Camera : Behaviour
    {
        public static Camera main { get; set; }

        public static Camera current { get; set; }

        /// <summary>Points of the screen are metres of a picture that lies one metre ahead, its middle at zero.</summary>
        public Ray ScreenPointToRay(Vector3 at)
        {
            Vector3 through = transform.TransformPoint(new Vector3(at.x, at.y, 1));
            return new Ray(transform.position, through - transform.position);
        }
    }

    public static class Input
    {
        internal static bool IsDown, WasDown;

        public static Vector3 mousePosition { get; internal set; }

        public static bool GetMouseButton(int button) => button == 0 && IsDown;

        public static bool GetMouseButtonDown(int button) => button == 0 && IsDown && !WasDown;
    }

    public enum RuntimeInitializeLoadType
    {
        AfterSceneLoad = 0,
        BeforeSceneLoad = 1,
        AfterAssembliesLoaded = 2,
        BeforeSplashScreen = 3,
        SubsystemRegistration = 4,
    }

    [AttributeUsage(AttributeTargets.Method)]
    public sealed class RuntimeInitializeOnLoadMethodAttribute : Attribute
    {
        public RuntimeInitializeOnLoadMethodAttribute(RuntimeInitializeLoadType loadType) => this.loadType = loadType;

        public RuntimeInitializeLoadType loadType { get; }
    }
}

namespace UnityEngine.Events
{
    public class UnityEvent<T>
    {
        private Action<T> _calls = value => { };

        public void AddListener(UnityAction<T> call) => _calls += new Action<T>(call);

        public void Invoke(T value) => _calls(value);
    }

    public delegate void UnityAction<T>(T value);
}
