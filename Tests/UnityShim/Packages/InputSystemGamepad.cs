using System.Collections.Generic;
using UnityShim;

namespace UnityEngine.InputSystem
{
    public class Gamepad : InputDevice
    {
        public static Gamepad? current { get; internal set; }

        internal List<(double Seconds, float Low, float High)> Speeds { get; } =
            new List<(double, float, float)>();

        internal Gamepad(string name) => displayName = name;

        public virtual void SetMotorSpeeds(float lowFrequency, float highFrequency) =>
            Speeds.Add((Clock.UnscaledSeconds, Mathf.Clamp01(lowFrequency), Mathf.Clamp01(highFrequency)));
    }
}

namespace UnityShim
{
    /// <summary>A connected gamepad, and the speeds that its motors were set to.</summary>
    public sealed class HeldGamepad
    {
        private readonly UnityEngine.InputSystem.Gamepad pad;

        private HeldGamepad(string name) => pad = new UnityEngine.InputSystem.Gamepad(name);

        public IReadOnlyList<(double Seconds, float Low, float High)> Speeds => pad.Speeds;

        /// <summary>The pad is the one that was used last.</summary>
        public bool IsCurrent
        {
            get => UnityEngine.InputSystem.Gamepad.current == pad;
            set => UnityEngine.InputSystem.Gamepad.current = value ? pad : null;
        }

        public static HeldGamepad Take(string name) => new HeldGamepad(name) { IsCurrent = true };
    }
}
