using System;
using System.Collections.Generic;
using System.Reflection;
using UnityEditor;

namespace UnityShim
{
    /// <summary>What the editor around a window does to it, and the user's answers.</summary>
    public static class WindowHost
    {
        /// <summary>Of the screen that windows are on.</summary>
        public static float PixelsPerPoint { get; set; } = 1f;

        /// <summary>Where to save, from the name that is proposed; null to cancel.</summary>
        public static Func<string, string>? AnswerToSave { get; set; }

        /// <summary>Which file to open; null to cancel.</summary>
        public static Func<string>? AnswerToOpen { get; set; }

        /// <summary>What a window showed for a moment.</summary>
        public static string Notification { get; internal set; } = "";

        /// <summary>An update of the editor, of which there are some hundred a second.</summary>
        public static void Update()
        {
            EditorApplication.RunDelayed();
            EditorApplication.update?.Invoke();
        }

        public static void Close(EditorWindow window)
        {
            Messages messages = Messages.Of(window);
            messages.Send(Message.OnDisable);
            messages.Send(Message.OnDestroy);
            window.Close();
        }

        /// <summary>A domain reload as a window sees it: what it keeps serialized stays, the rest begins
        /// anew.</summary>
        public static void Reload(EditorWindow window)
        {
            Messages messages = Messages.Of(window);
            EditorSession.ReloadScripts();
            messages.Send(Message.OnDisable);
            messages.Send(Message.OnEnable);
        }

        /// <summary>One pass of drawing, with the present event.</summary>
        public static IReadOnlyList<Drawn> Draw(EditorWindow window)
        {
            const BindingFlags any = BindingFlags.Instance | BindingFlags.Public | BindingFlags.NonPublic;
            MethodInfo draw = window.GetType().GetMethod("OnGUI", any) ??
                throw new InvalidOperationException(window.GetType().Name + " draws nothing");
            return EditorScreen.Draw((Action)Delegate.CreateDelegate(typeof(Action), window, draw));
        }
    }
}
